//! Compares the times of a frame: ours and a peer's, on one context, in turns.

use std::time::{Duration, Instant};

use fragbuf_follow::Scene;
use glow::HasContext as _;

use crate::host::Host;
use crate::peer::Peer;
use crate::{Context, Error};

/// The frames that are drawn before the first that is measured. Drivers compile shaders in the first one.
pub const WARM_UP: u32 = 3;

/// Frame times of both sides, frame by frame: those of equal index were measured one after the other.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Our frame times.
    pub ours: Vec<Duration>,
    /// The peer's frame times.
    pub theirs: Vec<Duration>,
    /// The median time of each of our passes, measured one at a time in further frames.
    pub our_passes: Vec<(String, Duration)>,
    /// The same of the peer's passes.
    pub their_passes: Vec<(String, Duration)>,
    /// The greatest difference between the two images, in any channel.
    pub difference: f32,
}

/// Draws `repeats` frames of each in turns. Each scene holds the vertices as its side expects them.
pub fn compare(
    context: &Context,
    (host, ours): (&mut Host<'_>, &Scene<'_>),
    (peer, theirs): (&mut Peer<'_>, &Scene<'_>),
    repeats: u32,
) -> Result<Comparison, Error> {
    let background = [1.0; 4];
    peer.upload(theirs);
    let (first, second) = (host.render(ours, background)?, peer.render(theirs, background)?);
    let pairs = first.pixels.iter().flatten().zip(second.pixels.iter().flatten());
    let difference = pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f32::max);
    let (mut our_times, mut their_times) = (Vec::new(), Vec::new());
    for frame in 0..WARM_UP + repeats {
        let begin = finished_at(context);
        host.draw(ours, background)?;
        let middle = finished_at(context);
        peer.draw(theirs, background);
        let end = finished_at(context);
        if frame >= WARM_UP {
            our_times.push(middle - begin);
            their_times.push(end - middle);
        }
    }
    let (mut our_frames, mut their_frames) = (Vec::new(), Vec::new());
    for _ in 0..repeats {
        host.pass_times = Some(Vec::new());
        host.draw(ours, background)?;
        our_frames.extend(host.pass_times.take());
        peer.pass_times = Some(Vec::new());
        peer.draw(theirs, background);
        their_frames.extend(peer.pass_times.take());
    }
    Ok(Comparison {
        ours: our_times,
        theirs: their_times,
        our_passes: medians(&our_frames),
        their_passes: medians(&their_frames),
        difference,
    })
}

/// Returns the median time of each pass over frames.
fn medians(frames: &[Vec<(String, Duration)>]) -> Vec<(String, Duration)> {
    let Some(first) = frames.first() else { return Vec::new() };
    let of_pass = |index: usize, name: &String| {
        let mut times: Vec<Duration> = frames.iter().filter_map(|frame| Some(frame.get(index)?.1)).collect();
        times.sort();
        (name.clone(), times.get(times.len() / 2).copied().unwrap_or_default())
    };
    first.iter().enumerate().map(|(index, (name, _))| of_pass(index, name)).collect()
}

/// Waits for the driver; returns the time.
pub(crate) fn finished_at(context: &Context) -> Instant {
    // SAFETY: the context is current.
    unsafe { context.gl.finish() };
    Instant::now()
}
