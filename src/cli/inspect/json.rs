//! What was found, as JSON. Bytes and voxels are counts; units of the others are in the keys.

use serde_json::{Map, Value, json};

use super::Found;
use super::measure::Measured;
use super::structures::structures;
use super::subject::Sample;
use crate::neighbors::occupancy::{Figures, Slice};

pub fn report(found: &Found) -> Value {
    let subject = &found.subject;
    let census = &subject.census;
    let octree = census.octree();
    let domain = census.grid.domain_voxels();
    let mut report = json!({
        "scene": subject.scene.name,
        "frame": subject.frame,
        "time_s": subject.simulated.then_some(subject.time),
        "particles": subject.scene.particles.len(),
        "boundary_particles": subject.scene.boundary.len(),
        "particles_quarantined": census.quarantined,
        "slicing_axis": (["x", "y", "z"][census.grid.axis as usize]),
        "voxel_side": census.grid.side,
        "voxels_domain": domain,
    });
    let object = report.as_object_mut().expect("an object");
    object.extend(histogram(&census.figures()));
    object.insert(
        "octree".into(),
        json!({
            "children": octree.children,
            "levels": octree.levels,
            "leaves": octree.leaves,
            "inner_nodes": octree.inner,
            "leaves_allocated_together": octree.allocated_leaves,
            "inner_nodes_allocated_together": octree.allocated_inner,
        }),
    );
    object.insert(
        "grids".into(),
        found.grids.iter().map(|one| grid(one, domain as f64)).collect(),
    );
    let memory = structures(found).into_iter().map(|one| {
        json!({
            "name": one.name,
            "cells": one.cells,
            "share_of_domain": one.cells as f64 / domain as f64,
            "overflow": one.overflow,
            "bytes": one.bytes,
            "share_of_uniform_bytes": one.bytes as f64 / one.uniform_bytes.max(1) as f64,
        })
    });
    object.insert("memory".into(), memory.collect());
    object.insert("slices".into(), slices(found));
    if !subject.over_time.is_empty() {
        let boundary = subject.scene.boundary.len();
        let samples = subject
            .over_time
            .iter()
            .map(|one| sample(one, boundary, &found.grids));
        object.insert("over_time".into(), samples.collect());
    }
    report
}

fn histogram(figures: &Figures) -> Map<String, Value> {
    let [one, two, three, four] = figures.with;
    let counts = json!({
        "voxels_occupied": figures.occupied,
        "voxels_with_1": one,
        "voxels_with_2": two,
        "voxels_with_3": three,
        "voxels_with_4": four,
        "voxels_with_more": figures.with_more,
    });
    match counts {
        Value::Object(counts) => counts,
        _ => unreachable!("an object was written"),
    }
}

fn grid(one: &Measured, domain: f64) -> Value {
    let allocation = &one.allocation;
    let buffers = allocation.buffers.iter();
    let buffers: Map<_, _> = buffers
        .map(|buffer| (buffer.name.clone(), buffer.bytes.into()))
        .collect();
    let mut report = json!({
        "grid": one.name,
        "counted_on": if one.device.is_some() { "device" } else { "host" },
        "voxels_allocated": one.voxels(),
        "share_of_domain": one.voxels() as f64 / domain,
        "overflow": one.overflow(),
        "bytes": allocation.bytes,
        "bytes_per_voxel": allocation.bytes_per_voxel,
        "bytes_that_grow_with_particles": allocation.particle_bytes,
        "buffers": buffers,
    });
    if let Some(device) = one.device {
        let figures = Figures {
            particles: 0,
            occupied: device.voxels_occupied.into(),
            with: device.voxels_with.map(u64::from),
            with_more: device.voxels_with_more.into(),
        };
        report
            .as_object_mut()
            .expect("an object")
            .extend(histogram(&figures));
    }
    report
}

fn slices(found: &Found) -> Value {
    let slice = |slice: Slice| {
        let by_grid = |of: &dyn Fn(&Measured, u64) -> u64| -> Map<String, Value> {
            let voxels = |one: &Measured| one.in_slice(slice.at).map(|voxels| of(one, voxels));
            let grids = found.grids.iter();
            grids.map(|one| (one.name.clone(), voxels(one).into())).collect()
        };
        let mut report = json!({
            "slice": slice.at,
            "particles": slice.particles(),
            "boundary_particles": slice.boundary,
        });
        let object = report.as_object_mut().expect("an object");
        object.extend(histogram(&slice.figures));
        object.insert("voxels_allocated".into(), by_grid(&|_, voxels| voxels).into());
        let bytes = by_grid(&|one, voxels| voxels * one.allocation.bytes_per_voxel);
        object.insert("bytes".into(), bytes.into());
        report
    };
    found.subject.census.slices().into_iter().map(slice).collect()
}

fn sample(one: &Sample, boundary: usize, grids: &[Measured]) -> Value {
    let by_grid = |of: fn(&(u64, u64)) -> u64| -> Map<String, Value> {
        let names = grids.iter().map(|grid| grid.name.clone());
        names.zip(one.grids.iter().map(|grid| of(grid).into())).collect()
    };
    let mut report = json!({
        "frame": one.frame,
        "time_s": one.time,
        "particles": one.particles,
        "boundary_particles": boundary,
    });
    let object = report.as_object_mut().expect("an object");
    object.extend(histogram(&one.figures));
    object.insert("octree_leaves".into(), one.octree.leaves.into());
    object.insert("octree_inner_nodes".into(), one.octree.inner.into());
    object.insert("voxels_allocated".into(), by_grid(|grid| grid.0).into());
    object.insert("bytes".into(), by_grid(|grid| grid.1).into());
    report
}
