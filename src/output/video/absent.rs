//! A build without video encoders refuses videos.

use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::output::Sink;
use crate::output::manifest::Files;
use crate::scene::Scene;
use crate::simulation::frame::Frame;

/// There is none.
#[derive(Debug, Clone)]
pub struct VideoOutput {
    never: Infallible,
}

impl VideoOutput {
    pub fn new(path: &Path) -> Result<Self> {
        Err(Error::absent(format!(
            "this build has no video encoders, so it cannot make {}",
            path.display()
        )))
    }

    pub fn path(&self) -> &Path {
        match self.never {}
    }

    pub fn part_from(&self, _first: u32, _folder_of: impl Fn(&Path) -> PathBuf) -> Self {
        match self.never {}
    }

    pub fn check(&self, _force: bool) -> Result<()> {
        match self.never {}
    }

    pub fn note(&self, _scene: &Scene) -> Option<String> {
        match self.never {}
    }

    pub fn bytes(&self, _scene: &Scene) -> f64 {
        match self.never {}
    }

    pub fn files(&self) -> Files {
        match self.never {}
    }
}

/// There is none.
pub struct Video {
    never: Infallible,
}

impl Video {
    pub fn new(output: VideoOutput, _scene: &Scene, _pictures: Option<&Path>) -> Result<Self> {
        match output.never {}
    }
}

impl Sink for Video {
    fn frame(&mut self, _frame: &Arc<Frame>) -> Result<()> {
        match self.never {}
    }

    fn finish(&mut self) -> Result<()> {
        match self.never {}
    }
}
