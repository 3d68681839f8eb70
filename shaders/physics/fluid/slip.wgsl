// Whether fluid slips along walls.
#if slips
const SLIPS: bool = true;
#else
const SLIPS: bool = false;
#end
