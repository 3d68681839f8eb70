// Which one this is of the passes that run the same entry point (PassPlan::index).

var<uniform> pass_index: u32;
