//! Every shader of every variant, without a GPU.

mod composed;
mod plans;
mod valid;

use std::collections::{BTreeSet, HashMap};
use std::sync::LazyLock;

use sliceflow::gpu::Shader;
use sliceflow::gpu::compose::compose;
use sliceflow::plan::{PassRow, Plan, Wanted};
use sliceflow::scene::column::{COLUMNS, Source};

/// Plans and the shaders of their passes. Most plans share most of them.
struct Composed {
    plans: Vec<Plan>,
    /// One for each composed text, which may have several entry points.
    shaders: Vec<Result<Shader, String>>,
    /// Of each plan, the places of its passes' shaders.
    places: Vec<Vec<usize>>,
    /// Flags that they depend on, and whether they were set.
    flags: BTreeSet<(String, bool)>,
}

impl Composed {
    /// Each plan with its passes.
    fn passes(&self) -> impl Iterator<Item = (&Plan, Vec<Bound<'_>>)> {
        self.plans.iter().zip(&self.places).map(|(plan, places)| {
            let rows = plan.passes.iter().zip(places).map(|(row, &place)| {
                let resources = self.shaders[place]
                    .as_ref()
                    .map_err(Clone::clone)
                    .and_then(|shader| {
                        let resources = shader
                            .resources(&row.pass.entry)
                            .map_err(|error| error.to_string())?;
                        Ok(resources.into_iter().map(|resource| resource.name).collect())
                    });
                (row, resources)
            });
            (plan, rows.collect())
        })
    }
}

/// A pass and the names of its shader's resources.
type Bound<'a> = (&'a PassRow, Result<Vec<String>, String>);

static COMPOSED: LazyLock<Composed> = LazyLock::new(|| {
    let mut composed = Composed {
        plans: plans::plans(),
        shaders: Vec::new(),
        places: Vec::new(),
        flags: BTreeSet::new(),
    };
    let mut by_text = HashMap::new();
    for plan in &composed.plans {
        // Passes of one file and phase are composed alike.
        let mut by_file = HashMap::new();
        let places = plan.passes.iter().map(|row| {
            let file = (row.pass.shader.as_str(), row.phase as u8);
            *by_file.entry(file).or_insert_with(|| {
                let found = compose(&row.pass.shader, &plan.variant_of(row.phase));
                let found = found.unwrap_or_else(|error| panic!("{error}"));
                composed.flags.extend(found.flags.iter().cloned());
                *by_text.entry(found.text.clone()).or_insert_with(|| {
                    let shader = Shader::from_composed(&found);
                    composed.shaders.push(shader.map_err(|error| error.to_string()));
                    composed.shaders.len() - 1
                })
            })
        });
        composed.places.push(places.collect());
    }
    composed
});

fn wanted() -> Wanted {
    let measured = COLUMNS.iter().copied().filter(|c| c.source == Source::Measured);
    Wanted {
        statistics: true,
        columns: measured.collect(),
        columns_every: 0,
        view: None,
        voxel_map: Some(64),
        ..Wanted::default()
    }
}

/// An obstacle that rests.
const BLOCK: &str = "colliders=[{\"shape\":{\"kind\":\"sphere\",\"center\":[0.5,0.1],\"radius\":0.05}}]";
