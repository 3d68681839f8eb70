//! A build without Rerun refuses recordings, and says how to get a build that makes them.

use super::Settings;
use crate::error::{Error, Result};
use crate::output::Sink;
use crate::output::progress::Progress;
use crate::plan::{Plan, Wanted};
use crate::scene::Scene;

impl Settings {
    pub fn check(&self, _scene: &Scene, _pictures: bool, _force: bool) -> Result<()> {
        let names: Vec<_> = self.targets.iter().map(ToString::to_string).collect();
        Err(Error::absent(format!(
            "this build has no Rerun, so nothing goes to {}",
            names.join(" or ")
        )))
    }

    pub fn want(&self, _scene: &Scene, _pictures: bool, _wanted: &mut Wanted) {}

    pub fn disk_bytes(&self, _scene: &Scene, _pictures: bool) -> u64 {
        0
    }

    pub fn sinks(
        &self,
        scene: &Scene,
        _plan: &Plan,
        pictures: bool,
        _progress: &Progress,
    ) -> Result<Vec<Box<dyn Sink>>> {
        self.check(scene, pictures, false).map(|()| Vec::new())
    }
}
