//! The device that networks are trained on: the processor, or a GPU.

use std::fmt;

use burn::tensor::Device;

#[cfg(feature = "gpu-wgsl")]
use super::guard::guarded;
use super::samples::PixelLayout;
#[cfg(feature = "gpu-wgsl")]
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
