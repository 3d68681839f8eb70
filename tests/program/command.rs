//! The program, started with arguments.

use assert_cmd::{Command, cargo_bin_cmd};

pub fn sliceflow(args: &[&str]) -> Command {
    let mut command = cargo_bin_cmd!("sliceflow");
    command.args(args);
    command
}

/// Standard output of a command that succeeds.
pub fn output(args: &[&str]) -> String {
    let assert = sliceflow(args).assert().success();
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// Standard error of a command that fails with this exit status.
pub fn failure(args: &[&str], status: i32) -> String {
    let assert = sliceflow(args).assert().code(status);
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}
