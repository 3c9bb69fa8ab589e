//! The device that networks are trained on: the processor, or a GPU.

use std::cell::Cell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use burn::tensor::Device;

use super::samples::PixelLayout;
use super::tensors::device_failed;
use nfr_convert::error::Error;

/// A device, and what is known about it.
#[derive(Debug, Clone)]
pub struct Accelerator {
    /// Where tensors live, without autodiff.
    pub device: Device,
    /// The adapter's name as its driver gives it, or `CPU`.
    pub name: String,
    /// The processor itself, a GPU, or a driver that computes a GPU's work on the processor.
    pub kind: AcceleratorKind,
}

/// The kind of an accelerator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AcceleratorKind {
    /// burn's CPU backend.
    Processor,
    /// A GPU.
    Gpu,
    /// A driver without a GPU, such as lavapipe: right, but too slow for its times to mean anything.
    Software,
}

impl Accelerator {
    /// The processor.
    pub fn processor() -> Self {
        Self { device: Device::flex(), name: "CPU".into(), kind: AcceleratorKind::Processor }
    }

    /// The adapter that wgpu prefers, or that the environment variable `CUBECL_WGPU_DEFAULT_DEVICE` names, by Vulkan where
    /// there is a driver for it.
    /// A process can do this once.
    ///
    /// # Errors
    ///
    /// `Device` if there is no adapter, or it cannot be used.
    #[cfg(feature = "gpu-wgsl")]
    pub fn gpu() -> Result<Self, Error> {
        use burn::tensor::wgpu::WgpuInitError;
        use burn::tensor::wgpu::wgpu::DeviceType;

        let found = guarded(|| {
            Device::wgpu_options().init_with_setup().map_err(|error| {
                let first = error.to_string().lines().next().unwrap_or_default().to_owned();
                Error::Device(match error {
                    WgpuInitError::AdapterUnavailable { .. } => format!(
                        "no GPU is found ({first}); install Vulkan's loader (Debian: libvulkan1) and the driver of the \
                         card, or use --device cpu"
                    ),
                    _ => format!("the GPU cannot be used ({first}); use --device cpu"),
                })
            })
        });
        let (device, setup) = found?;
        let info = setup.adapter.get_info();
        let kind = match info.device_type {
            DeviceType::Cpu => AcceleratorKind::Software,
            _ => AcceleratorKind::Gpu,
        };
        Ok(Self { device, name: info.name, kind })
    }

    /// How pixels lie in tensors for it to be fast.
    pub fn layout(&self) -> PixelLayout {
        match self.kind {
            AcceleratorKind::Processor => PixelLayout::Whole,
            AcceleratorKind::Gpu | AcceleratorKind::Software => PixelLayout::Groups,
        }
    }

    /// Whether times that were taken on it say anything.
    pub fn is_timed(&self) -> bool {
        self.kind != AcceleratorKind::Software
    }
}

impl fmt::Display for Accelerator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)?;
        match self.kind {
            AcceleratorKind::Software => f.write_str(", a software adapter"),
            AcceleratorKind::Processor | AcceleratorKind::Gpu => Ok(()),
        }
    }
}

/// Does work on a device. A device that fails (it is lost, or its memory is full) makes burn panic: that becomes an error.
///
/// # Errors
///
/// `Device` after a panic; those of the work.
pub fn guarded<R>(work: impl FnOnce() -> Result<R, Error>) -> Result<R, Error> {
    silence_guarded();
    let outer = GUARDED.replace(true);
    // After a failure nothing of what the work used is used again.
    let done = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(outer);
    done.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason is given");
        Err(device_failed(text))
    })
}

thread_local! {
    /// Whether a panic of this thread becomes an error.
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Leaves panics that become errors out of what the program prints.
fn silence_guarded() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let others = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !GUARDED.get() {
                others(info);
            }
        }));
    });
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_fails_is_an_error_of_one_line() {
        let lost = guarded(|| -> Result<(), Error> { panic!("device {} lost\nat line 7", 3) });
        let text = lost.unwrap_err().to_string();
        assert!(
            text.contains("(device 3 lost)") && text.contains("--resume") && text.lines().count() == 1,
            "{text}"
        );
        assert_eq!(guarded(|| Ok(7)), Ok(7));
        let full = guarded(|| Err::<(), _>(Error::Io("the disk is full".into())));
        assert_eq!(full, Err(Error::Io("the disk is full".into())));
    }
}
