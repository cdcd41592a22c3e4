//! Reports the counters of frames to the main world, some frames later and without a wait.
//!
//! Input: followers after their frames. Output: a diagnostic per counter, `fragbuf/NAME/COUNTER`, the sum of losses as
//! `fragbuf/NAME/lost`, and the component [`FragmentCounters`] of the camera.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex};

use bevy::diagnostic::{Diagnostic, DiagnosticMeasurement, DiagnosticPath, DiagnosticsStore};
use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::render::sync_world::MainEntity;

use super::FragmentCounters;
use super::views::FollowedViews;
use crate::follower::{CounterNames, Follower};

/// The most copies that wait for the device at once. Frames beyond are not counted.
const MOST_WAITING: usize = 8;

/// The counters of a frame of a camera.
struct Report {
    camera: Entity,
    name: String,
    counters: FragmentCounters,
}

/// Where the render world sends reports.
#[derive(Resource)]
pub struct Reports {
    sender: Sender<Report>,
    waiting: Vec<Waiting>,
}

/// A copy of the counters of a frame.
struct Waiting {
    camera: Entity,
    names: CounterNames,
    bytes: u64,
    words: wgpu::Buffer,
    /// Whether the words can be read; `None`: the copy has not been requested.
    is_mapped: Option<Arc<AtomicBool>>,
}

/// Where the main world receives reports.
#[derive(Resource)]
pub struct Received(Mutex<Receiver<Report>>);

/// Returns both ends.
pub fn channel() -> (Reports, Received) {
    let (sender, receiver) = std::sync::mpsc::channel();
    (Reports { sender, waiting: Vec::new() }, Received(Mutex::new(receiver)))
}

impl Reports {
    /// Records a copy of the counters of a frame behind its passes.
    pub fn record(&mut self, follower: &Follower, bytes: u64, camera: MainEntity, encoder: &mut wgpu::CommandEncoder) {
        if self.waiting.len() >= MOST_WAITING {
            return;
        }
        let Some(words) = follower.copy_counters(encoder) else { return };
        let names = follower.counter_names();
        self.waiting.push(Waiting { camera: camera.id(), names, bytes, words, is_mapped: None });
    }
}

/// Requests the words of frames that have been submitted, and sends those that have arrived.
pub fn read(mut reports: ResMut<Reports>, _: Res<FollowedViews>) {
    let Reports { sender, waiting } = &mut *reports;
    waiting.retain_mut(|waiting| match &waiting.is_mapped {
        None => {
            let is_mapped = Arc::new(AtomicBool::new(false));
            waiting.is_mapped = Some(is_mapped.clone());
            waiting.words.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                is_mapped.store(result.is_ok(), Ordering::Release);
            });
            true
        }
        Some(is_mapped) if !is_mapped.load(Ordering::Acquire) => true,
        Some(_) => {
            let counters = waiting.names.counters(&waiting.words.slice(..).get_mapped_range());
            let counters = FragmentCounters { counters, bytes: waiting.bytes };
            let report = Report { camera: waiting.camera, name: waiting.names.buffer.clone(), counters };
            // The main world is gone when the app ends.
            let _ = sender.send(report);
            false
        }
    });
}

/// Adds the measurements of reports.
pub fn report(received: Res<Received>, mut store: ResMut<DiagnosticsStore>, mut commands: Commands) {
    let Ok(receiver) = received.0.lock() else { return };
    for Report { camera, name, counters } in receiver.try_iter() {
        let lost = [("lost", counters.counters.lost), ("bytes", counters.bytes)];
        let by_name = counters.counters.by_name.iter().map(|(counter, value)| (counter.as_str(), *value));
        for (counter, value) in lost.into_iter().chain(by_name) {
            let path = DiagnosticPath::new(format!("fragbuf/{name}/{counter}"));
            if store.get(&path).is_none() {
                store.add(Diagnostic::new(path.clone()));
            }
            if let Some(diagnostic) = store.get_mut(&path) {
                diagnostic.add_measurement(DiagnosticMeasurement { time: Instant::now(), value: value as f64 });
            }
        }
        if let Ok(mut camera) = commands.get_entity(camera) {
            camera.insert(counters);
        }
    }
}
