// Entries of `voxel_start` (neighbors::storage::entries).

// Of the voxels and the quarantine behind them.
fn row_length(voxels: u32) -> u32 {
    return voxels + 1u;
}

// Of all rows, and one more for the end.
fn entries(voxels: u32) -> u32 {
#if separated
    return 2u * row_length(voxels) + 1u;
#else
    return row_length(voxels) + 1u;
#end
}
