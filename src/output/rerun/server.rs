//! Rerun's own program, started as a viewer with a window or as a server for browsers.

use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use ::rerun::SpawnOptions;
use ::rerun::external::re_build_info::CrateVersion;

use super::{GRPC_PORT, LOCALHOST, WEB_PORT};
use crate::error::{Error, Result};

/// How long the program may take to listen; on a busy machine it loads for some seconds.
const START: Duration = Duration::from_secs(30);

/// Starts a viewer with a window, unless one listens already. It outlives this program.
pub fn spawn_viewer() -> Result<()> {
    let options = SpawnOptions {
        port: GRPC_PORT,
        wait_for_bind: true,
        hide_welcome_screen: true,
        extra_args: vec![format!("--bind={LOCALHOST}")],
        ..SpawnOptions::default()
    };
    ::rerun::spawn(&options).map(|_| ()).map_err(|error| {
        let reason = error.to_string();
        not_started(reason.lines().next().unwrap_or_default())
    })
}

/// A server of recordings, with a viewer for browsers. It ends with its owner.
pub struct Server {
    child: Child,
}

impl Server {
    pub fn start() -> Result<Self> {
        let mut command = Command::new("rerun");
        command
            .arg("--serve-web")
            .arg(format!("--bind={LOCALHOST}"))
            .arg(format!("--port={GRPC_PORT}"))
            .arg(format!("--web-viewer-port={WEB_PORT}"))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        // Ctrl-C is for this program, which may have something to show still.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child = command.spawn().map_err(|error| not_started(&error.to_string()))?;
        let mut server = Self { child };
        let patience = Instant::now();
        while TcpStream::connect((LOCALHOST, GRPC_PORT)).is_err() {
            if let Ok(Some(status)) = server.child.try_wait() {
                return Err(not_started(&status.to_string()));
            }
            if patience.elapsed() > START {
                return Err(not_started(&format!("it does not listen on port {GRPC_PORT}")));
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        Ok(server)
    }

    /// Where a browser finds the recording.
    pub fn address() -> String {
        format!("http://{LOCALHOST}:{WEB_PORT}/?url=rerun%2Bhttp://{LOCALHOST}:{GRPC_PORT}/proxy")
    }

    /// Ports that something else has taken.
    pub fn check_ports() -> Result<()> {
        let taken = |port: &u16| TcpListener::bind((LOCALHOST, *port)).is_err();
        match [GRPC_PORT, WEB_PORT].iter().find(|port| taken(port)) {
            Some(port) => Err(Error::usage(
                format!("port {port} of {LOCALHOST} is taken, so Rerun cannot serve there"),
                "end the program that has it, or send to a viewer that runs already with --rerun-connect",
            )),
            None => Ok(()),
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // pip's `rerun` is a script that starts the program proper, so the whole group has to go.
        #[cfg(unix)]
        let _ = Command::new("kill")
            .args(["-TERM", "--", &format!("-{}", self.child.id())])
            .stderr(Stdio::null())
            .status();
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn not_started(reason: &str) -> Error {
    Error::usage(
        format!("Rerun's program does not start: {reason}"),
        format!("install it: pip install rerun-sdk=={}", CrateVersion::LOCAL),
    )
}
