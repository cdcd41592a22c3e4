//! Answers that take longer: pictures, the histogram of depth complexity, and verdicts. Each is a command of this program.

use std::collections::BTreeMap;
use std::time::Duration;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Deserialize;
use serde_json::{Value, json};
use tokio::sync::Semaphore;

use super::child::{self, Job, Printed};
use super::description::Folder;
use super::generate::found;
use super::models::Models;
use super::problem::Problem;
use super::scene::{MEMORY, RequestedScene};

/// The time that a picture or a histogram may take.
const PICTURE: Duration = Duration::from_secs(60);

/// The time that a check may take.
const CHECK: Duration = Duration::from_secs(300);

/// The states that a check visits at most, which bound its memory.
const STATES: &str = "5000000";

/// The greatest side of a picture.
const MOST_PIXELS: u32 = 2048;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Orbit {
    /// Degrees.
    azimuth: f64,
    elevation: f64,
    zoom: f64,
}

impl Orbit {
    fn argument(&self) -> String {
        format!("orbit:{},{},zoom:{}", self.azimuth, self.elevation, self.zoom)
    }
}

/// A scene as the page shows it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Picture {
    text: String,
    scene: String,
    size: [u32; 2],
    camera: Orbit,
    #[serde(default)]
    uniforms: BTreeMap<String, Numbers>,
    k: Option<u32>,
    device: Option<String>,
}

/// The value of a uniform.
#[derive(Deserialize)]
#[serde(untagged)]
enum Numbers {
    One(f64),
    Several(Vec<f64>),
}

impl Numbers {
    fn argument(&self) -> String {
        match self {
            Numbers::One(number) => number.to_string(),
            Numbers::Several(numbers) => numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(","),
        }
    }
}

impl Picture {
    /// Returns the picture as a PNG in base64, and the statistics of its frame.
    pub(super) async fn render(&self, folder: &Folder, models: &Models) -> Result<Value, Problem> {
        let image =
            tempfile::tempdir().map_err(|error| Problem::server(format!("a folder for the picture: {error}")))?;
        let path = image.path().join("picture.png");
        let mut arguments = vec![format!("--out={}", path.display())];
        arguments.extend(self.k.map(|k| format!("--set=k={k}")));
        let printed = self.run("render", arguments, (folder, models)).await?;
        let statistics = json_of(&printed)?;
        let png = std::fs::read(&path).map_err(|error| Problem::server(format!("the picture: {error}")))?;
        Ok(json!({ "png": STANDARD.encode(png), "statistics": statistics, "messages": messages(&printed) }))
    }

    /// Returns the histogram of the fragments of a pixel.
    pub(super) async fn predict(&self, folder: &Folder, models: &Models) -> Result<Value, Problem> {
        let mut predicted = json_of(&self.run("predict", Vec::new(), (folder, models)).await?)?;
        // The command names the file of a model, which is of this machine.
        if let Some(scene) = predicted.get_mut("scene") {
            *scene = json!(self.scene);
        }
        Ok(predicted)
    }

    /// Runs a command with the arguments that `render` and `predict` share, and with others.
    async fn run(
        &self,
        command: &str,
        others: Vec<String>,
        (folder, models): (&Folder, &Models),
    ) -> Result<Printed, Problem> {
        folder.check(&self.text)?;
        let scene = RequestedScene::find(&self.scene, models)?;
        let mut arguments = vec![command.to_owned(), "-".to_owned(), "--json".to_owned(), "--no-references".to_owned()];
        arguments.extend(self.arguments(&scene)?);
        arguments.extend(others);
        let mut printed = run(&arguments, &self.text, folder, (PICTURE, &child::SHORT)).await?;
        printed.stderr = scene.shortened_in_json(&printed.stderr);
        Ok(printed)
    }

    /// Returns the arguments of the picture.
    fn arguments(&self, scene: &RequestedScene) -> Result<Vec<String>, Problem> {
        if self.size.iter().any(|side| *side == 0 || *side > MOST_PIXELS) {
            return Err(Problem::request(format!("a side of a picture has from 1 to {MOST_PIXELS} pixels")));
        }
        if !(-90.0..=90.0).contains(&self.camera.elevation) || !(0.01..=1000.0).contains(&self.camera.zoom) {
            return Err(Problem::request(
                "the elevation of a camera is from -90 to 90 degrees, and its zoom from 0.01 to 1000",
            ));
        }
        let [width, height] = self.size;
        let device = self.device.as_deref().unwrap_or("auto");
        let mut arguments = vec![
            format!("--scene={}", scene.argument()),
            format!("--size={width}x{height}"),
            format!("--camera={}", self.camera.argument()),
            format!("--device={device}"),
            format!("--memory={MEMORY}"),
        ];
        arguments.extend(self.uniforms.iter().map(|(name, value)| format!("--uniform={name}={}", value.argument())));
        Ok(arguments)
    }
}

/// A check by the model checker.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Check {
    text: String,
    target: Option<String>,
    fragments: Option<u32>,
    k: Option<u32>,
    model: Option<String>,
}

impl Check {
    /// Returns the report of `fragbuf check --json`.
    pub(super) async fn answer(&self, folder: &Folder) -> Result<Value, Problem> {
        folder.check(&self.text)?;
        self.target.as_deref().map(found).transpose()?;
        let mut arguments = vec!["check".to_owned(), "-".to_owned(), "--json".to_owned(), format!("--states={STATES}")];
        arguments.extend(self.target.iter().map(|target| format!("--target={target}")));
        arguments.extend(self.fragments.iter().map(|count| format!("--fragments={count}")));
        arguments.extend(self.k.iter().map(|k| format!("--k={k}")));
        arguments.extend(self.model.iter().map(|model| format!("--model={model}")));
        json_of(&run(&arguments, &self.text, folder, (CHECK, &child::LONG)).await?)
    }
}

async fn run(
    arguments: &[String],
    text: &str,
    folder: &Folder,
    (most, queue): (Duration, &'static Semaphore),
) -> Result<Printed, Problem> {
    // Without a folder of user files the command runs in an empty one: messages name files that are at hand.
    let empty = tempfile::tempdir().map_err(|error| Problem::server(format!("a folder for the command: {error}")))?;
    let folder = folder.0.as_deref().unwrap_or(empty.path());
    child::run(&Job { arguments, text, folder, most, queue }).await
}

/// Returns the JSON that a command printed. A command without output failed, and says why on stderr.
fn json_of(printed: &Printed) -> Result<Value, Problem> {
    serde_json::from_slice(&printed.stdout).map_err(|_| match printed.status.code() {
        Some(1..=3) => Problem::input(printed.messages()),
        _ => Problem::server(format!("the command ended with {}\n{}", printed.status, printed.messages())),
    })
}

/// Returns the messages of a command as JSON, one per line of stderr.
fn messages(printed: &Printed) -> Vec<Value> {
    printed.stderr.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}
