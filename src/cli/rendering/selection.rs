//! Selects the device of a command, and says which one it is and why.
//!
//! Input: `--device` and `--order`, a scene, and the descriptions that the command renders. Output: one device for all of them, so that
//! `compare` does not measure the difference between two rasterisers. The selection depends only on these and on the adapters of the
//! machine, never on time.

use fragbuf::{Registry, Variant};
use fragbuf_cpu::FragmentOrder;

use super::RenderRequest;
#[cfg(feature = "gpu")]
use super::{estimate::Work, gpu, result::fixed_layers};
#[cfg(feature = "figures")]
use crate::cli::device::order_text;
use crate::cli::device::{CPU, DeviceRequest};
use crate::cli::input::Input;
use crate::cli::output::{self, Failure};
use crate::cli::view::{SceneView, View};

/// The device that renders, and the reason.
pub(crate) struct DeviceSelection {
    pub(crate) device: SelectedDevice,
    /// A phrase that follows the name of the device.
    pub(crate) reason: String,
    /// Whether the device is a software driver that `auto` prefers to the CPU device.
    #[cfg(feature = "gpu")]
    is_preferred_driver: bool,
}

pub(crate) enum SelectedDevice {
    Cpu(FragmentOrder),
    #[cfg(feature = "gpu")]
    Gpu(fragbuf_runtime::wgpu::Adapter),
}

/// The layers of a pixel up to which software drivers run their sorts: Mesa's end the loops of an invocation after 65,535 iterations in
/// total, without an error, and an insertion sort has a half of the square of the layers.
#[cfg(feature = "gpu")]
const DRIVER_LAYERS: u32 = 256;

/// Selects the device for all `sides`: the requests of a command with their descriptions.
pub(crate) fn select(
    view: &View,
    scene: &SceneView,
    sides: &mut [(&RenderRequest<'_>, &mut Input)],
) -> Result<DeviceSelection, Failure> {
    let selection = select_device(view, scene, sides)?;
    if scene.batch.is_some() && matches!(selection.device, SelectedDevice::Cpu(_)) && !view.is_later_frame {
        output::note("the CPU device draws all triangles in one draw, in their order: `--batch` changes nothing");
    }
    Ok(selection)
}

fn select_device(
    view: &View,
    scene: &SceneView,
    sides: &mut [(&RenderRequest<'_>, &mut Input)],
) -> Result<DeviceSelection, Failure> {
    let cpu = |reason: String| DeviceSelection::cpu(view.order.unwrap_or_default(), reason);
    let selection = match &view.device {
        DeviceRequest::Cpu => return Ok(cpu("selected with `--device`".to_owned())),
        DeviceRequest::Named(name) => named(name, view.order)?,
        DeviceRequest::Auto if view.order.is_some() => cpu("the only device with `--order`".to_owned()),
        DeviceRequest::Auto => {
            let registry = Registry::builtin();
            let mut variants = Vec::new();
            for (request, input) in sides {
                variants.push(super::variant(request, input, scene, &registry)?);
            }
            automatic(view, scene, &variants, &registry).unwrap_or_else(cpu)
        }
    };
    selection.print(view);
    Ok(selection)
}

/// Selects the device of a figure: that of `--device`. `auto` is the first adapter, so that the work is that of compiled shaders; without
/// one, and with an order, it is the CPU device.
#[cfg(feature = "figures")]
pub(crate) fn select_for_figure(
    device: &DeviceRequest,
    order: Option<FragmentOrder>,
) -> Result<DeviceSelection, Failure> {
    let cpu = |reason: &str| DeviceSelection::cpu(order.unwrap_or_default(), reason.to_owned());
    Ok(match (device, order) {
        (DeviceRequest::Cpu, _) => cpu("selected with `--device`"),
        (DeviceRequest::Auto, Some(_)) => cpu("the only device that interleaves fragments by a seed"),
        (DeviceRequest::Named(name), _) => named(name, None)?,
        (DeviceRequest::Auto, None) => match fragbuf_runtime::headless::adapters().into_iter().next() {
            Some(adapter) => DeviceSelection {
                device: SelectedDevice::Gpu(adapter),
                reason: "the first adapter".to_owned(),
                is_preferred_driver: false,
            },
            None => cpu("no adapter found"),
        },
    })
}

impl DeviceSelection {
    /// Returns why the device cannot run a variant, as far as its features show it.
    #[cfg(feature = "figures")]
    pub(crate) fn missing(&self, variant: &Variant, registry: &Registry) -> Option<String> {
        match &self.device {
            SelectedDevice::Cpu(_) => None,
            SelectedDevice::Gpu(adapter) => gpu::missing(adapter, variant, registry),
        }
    }

    /// Returns the name of the device with its driver, and the order of fragments on the CPU device.
    #[cfg(feature = "figures")]
    pub(crate) fn description(&self) -> String {
        match &self.device {
            SelectedDevice::Cpu(order) => format!("{CPU} ({}), order {}", fragbuf::GENERATOR, order_text(*order)),
            SelectedDevice::Gpu(adapter) => {
                let info = adapter.get_info();
                format!("{}, {}, {} {}", info.name, info.backend, info.driver, info.driver_info).trim().to_owned()
            }
        }
    }

    fn cpu(order: FragmentOrder, reason: String) -> Self {
        DeviceSelection {
            device: SelectedDevice::Cpu(order),
            reason,
            #[cfg(feature = "gpu")]
            is_preferred_driver: false,
        }
    }

    /// Selects the CPU device, if `auto` selected a software driver and a pixel has more layers than it sorts. Returns whether it did.
    #[cfg(feature = "gpu")]
    pub(super) fn leave_driver(&mut self, layers: u32, view: &View) -> bool {
        let leaves = self.is_preferred_driver && layers > DRIVER_LAYERS;
        if leaves {
            let reason = format!("pixels have more than {DRIVER_LAYERS} layers, which {} may not sort", self.name());
            *self = DeviceSelection::cpu(view.order.unwrap_or_default(), reason);
            self.print(view);
        }
        leaves
    }

    #[cfg(not(feature = "gpu"))]
    pub(super) fn leave_driver(&mut self, _: u32, _: &View) -> bool {
        false
    }

    /// Prints the device and the reason, unless the JSON has them.
    fn print(&self, view: &View) {
        if !view.json {
            output::note(&format!("rendering on {}: {}", self.name(), self.reason));
        }
    }

    /// Returns the name of the device.
    pub(crate) fn name(&self) -> String {
        match &self.device {
            SelectedDevice::Cpu(_) => CPU.to_owned(),
            #[cfg(feature = "gpu")]
            SelectedDevice::Gpu(adapter) => adapter.get_info().name,
        }
    }
}

/// Returns the adapter for all variants: the first that can run them, if it is a GPU or a driver that is faster than the CPU device.
/// `Err`: the reason for the CPU device.
#[cfg(feature = "gpu")]
fn automatic(
    view: &View,
    scene: &SceneView,
    variants: &[Variant],
    registry: &Registry,
) -> Result<DeviceSelection, String> {
    let mut reason = "no adapter found".to_owned();
    for adapter in fragbuf_runtime::headless::adapters() {
        let info = adapter.get_info();
        let is_software = info.device_type == fragbuf_runtime::wgpu::DeviceType::Cpu;
        let faster = if is_software {
            let work = Work::of(scene, view.size, variants, registry);
            let fragments = work.in_words();
            if !work.is_faster_on_a_driver() {
                return Err(format!("estimated to be faster than {} for {fragments}", info.name));
            }
            if variants.iter().any(|variant| greatest_layers(variant) > DRIVER_LAYERS) {
                return Err(format!("{} may not sort more than {DRIVER_LAYERS} layers", info.name));
            }
            format!("estimated to be faster than the CPU device for {fragments}")
        } else {
            "a GPU".to_owned()
        };
        match variants.iter().find_map(|variant| gpu::missing(&adapter, variant, registry)) {
            None => {
                let (device, reason) = (SelectedDevice::Gpu(adapter), faster);
                return Ok(DeviceSelection { device, reason, is_preferred_driver: is_software });
            }
            Some(missing) => reason = format!("{} cannot run the description: {missing}", info.name),
        }
    }
    Err(reason)
}

/// Returns the layers of a pixel that a variant sorts at least, as far as it sets them: those that it keeps, or those of its resolve pass.
#[cfg(feature = "gpu")]
fn greatest_layers(variant: &Variant) -> u32 {
    variant.keep.unwrap_or(0).max(fixed_layers(variant).unwrap_or(0))
}

#[cfg(not(feature = "gpu"))]
fn automatic(_: &View, _: &SceneView, _: &[Variant], _: &Registry) -> Result<DeviceSelection, String> {
    Err("the only device of this build".to_owned())
}

#[cfg(feature = "gpu")]
fn named(name: &str, order: Option<FragmentOrder>) -> Result<DeviceSelection, Failure> {
    if order.is_some() {
        return Err(Failure::Usage("`--order` works only with `--device cpu`".to_owned()));
    }
    let adapter = fragbuf_runtime::headless::adapter(&fragbuf_runtime::headless::Choice::Named(name.to_owned()))?;
    let (device, reason) = (SelectedDevice::Gpu(adapter), "selected with `--device`".to_owned());
    Ok(DeviceSelection { device, reason, is_preferred_driver: false })
}

#[cfg(not(feature = "gpu"))]
fn named(name: &str, _: Option<FragmentOrder>) -> Result<DeviceSelection, Failure> {
    Err(Failure::Device(format!("no adapter is named `{name}`: this build has only the device `{CPU}`")))
}
