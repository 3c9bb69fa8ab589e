//! Bitmaps of several glyphs as batches of networks in lockstep.

use burn::tensor::{Device, Tensor};

use crate::implicit::{Implicit, ImplicitConfig};
use crate::samples::{ImplicitBatch, ImplicitSamples, PixelLayout, TrainingSample};
use crate::train::TrainableNetwork;
use nfr_convert::error::Error;

/// One bitmap for each network, all in boxes of the same side.
#[derive(Debug, Clone)]
pub struct LockstepBatch {
    /// Pixels along a side of the box.
    pub side: usize,
    /// Encoded positions `[networks, side², inputs]`.
    pub positions: Tensor<3>,
    /// Classes, one-hot `[networks, side², classes]`.
    pub classes: Tensor<3>,
    /// Encoded sizes `[networks, 1, inputs]`, if any network has them.
    pub sizes: Option<Tensor<3>>,
    /// 1 for networks whose layers add their inputs, 0 for those without residuals, `[networks, 1, 1, 1]`; without it all add them.
    pub residual: Option<Tensor<4>>,
    /// Floating-point operations of a step in its matrix products, those with zeros left out.
    pub operations: f64,
}

/// The batches of networks in lockstep, all on the device.
pub struct LockstepSamples {
    batches: Vec<LockstepBatch>,
    operations: Vec<f64>,
}

impl LockstepSamples {
    /// Encodes the bitmaps of each network, in boxes of the same sides in the same order.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for boxes of other sides.
    pub fn new(
        members: &[(Vec<TrainingSample>, ImplicitConfig)],
        networks: &[Implicit],
        device: &Device,
    ) -> Result<Self, Error> {
        let sides = |samples: &[TrainingSample]| {
            samples.iter().map(|sample| sample.truth.side).collect::<Vec<usize>>()
        };
        let of_first = members.first().map(|(samples, _)| sides(samples)).unwrap_or_default();
        if members.iter().any(|(samples, _)| sides(samples) != of_first) {
            return Err(Error::InvalidParameter(
                "networks in lockstep need bitmaps of the same sizes".into(),
            ));
        }
        let encode = |(samples, config): &(Vec<TrainingSample>, ImplicitConfig)| {
            ImplicitSamples::new(samples.clone(), samples.len(), *config, PixelLayout::Whole, device)
        };
        let encoded: Vec<ImplicitSamples> = members.iter().map(encode).collect();
        let ones = |network: &Implicit| f32::from(u8::from(network.is_residual()));
        let residual: Vec<f32> = networks.iter().map(ones).collect();
        let residual = residual.contains(&0.0).then(|| {
            Tensor::<1>::from_floats(residual.as_slice(), device).reshape([networks.len(), 1, 1, 1])
        });
        let mut operations = vec![0.0; networks.len()];
        let batch = |(number, side): (usize, &usize)| {
            let of_networks: Vec<ImplicitBatch> = encoded.iter().map(|set| set.batch(&[number])).collect();
            let mut all = 0.0;
            for ((sum, network), batch) in operations.iter_mut().zip(networks).zip(&of_networks) {
                let one = network.operations(batch);
                *sum += one;
                all += one;
            }
            LockstepBatch {
                side: *side,
                positions: padded(of_networks.iter().map(|(pixels, _)| Some(pixels.positions.clone()))),
                classes: padded(of_networks.iter().map(|(_, classes)| Some(classes.clone().unsqueeze()))),
                sizes: of_networks.iter().any(|(pixels, _)| pixels.sizes.is_some()).then(|| {
                    let size = |(pixels, _): &ImplicitBatch| pixels.sizes.clone().map(Tensor::unsqueeze);
                    padded(of_networks.iter().map(size))
                }),
                residual: residual.clone(),
                operations: all,
            }
        };
        let batches = of_first.iter().enumerate().map(batch).collect();
        Ok(Self { batches, operations })
    }

    /// The number of bitmaps of each network.
    pub fn len(&self) -> usize {
        self.batches.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.batches.is_empty()
    }

    /// The bitmap with this number of each network.
    pub fn batch(&self, number: usize) -> &LockstepBatch {
        &self.batches[number]
    }

    /// All bitmaps.
    pub fn batches(&self) -> &[LockstepBatch] {
        &self.batches
    }

    /// Floating-point operations of an epoch of each network.
    pub fn operations(&self) -> &[f64] {
        &self.operations
    }
}

/// Inputs `[1, rows, inputs]` of several networks as one tensor. What one lacks is zero.
fn padded(of_networks: impl Iterator<Item = Option<Tensor<3>>> + Clone) -> Tensor<3> {
    let known = of_networks.clone().flatten();
    let columns = known.clone().map(|x| x.dims()[2]).max().unwrap_or_default();
    let (rows, device) = known.map(|x| (x.dims()[1], x.device())).next().unwrap_or_default();
    let zeros = |columns: usize| Tensor::<3>::zeros([1, rows, columns], &device);
    let pad = |x: Option<Tensor<3>>| match x {
        None => zeros(columns),
        Some(x) if x.dims()[2] == columns => x,
        Some(x) => {
            let missing = columns - x.dims()[2];
            Tensor::cat(vec![x, zeros(missing)], 2)
        }
    };
    Tensor::cat(of_networks.map(pad).collect(), 0)
}
