use super::super::larger_sizes::{TrainedMask, with_larger_sizes};
use super::super::tensors::values;
use super::twin::Twin;
use super::*;
use crate::fit::{Parameters, initial_fit};
use crate::fixtures::glyph_samples;
use crate::options::Capacity;
use crate::train::batch::GROUPS;
use crate::training_samples::GlyphSamples;
use burn::tensor::Device;
use nfr::Target;
use nfr::internals::model::gridfit::{GridFit, Scale, Weights};
use nfr::{Bitmap, Placement};

/// Bitmaps are rounded to 1/255.
const ROUNDING: f32 = 0.5 / 255.0;
/// The error of single precision, whose operations are in another order.
const PRECISION: f32 = 1e-3;

/// Training samples with the twin's bitmaps, border included, instead of the teacher's.
fn twin_samples(samples: &GlyphSamples, weights: &Weights, scale: Scale) -> GlyphSamples {
    let mut samples = samples.clone();
    let model = GridFit::new(weights, scale).unwrap();
    for sample in &mut samples.sizes {
        let ppem = f32::from(sample.ppem);
        let p = model.placement(ppem).unwrap();
        let placement =
            Placement { left: p.left - 4, top: p.top + 4, width: p.width + 8, height: p.height + 8 };
        let twin = Twin::new(weights, scale, ppem.into());
        let pixels = twin.draw(placement).iter().map(|pixel| pixel.round() as u8).collect();
        sample.bitmap = Bitmap { placement, pixels };
    }
    samples
}

/// Makes the deformation's weights other than zero.
fn deform(parameters: &mut Parameters) {
    for (k, v) in parameters.embedding.iter_mut().enumerate() {
        *v = (k % 17) as f32 / 32.0 - 0.25;
    }
}

/// The largest difference of a pixel between what training evaluates and the twin, and the number
/// of pixels.
fn largest_difference(text: &str, target: Target) -> (f32, usize) {
    let device = Device::flex();
    let (glyphs, scale) = glyph_samples(text, target);
    let mut parameters: Vec<Parameters> =
        glyphs.iter().map(|samples| initial_fit(samples, scale, target, Capacity::default(), 1)).collect();
    parameters.iter_mut().for_each(deform);
    let stored: Vec<Weights> = parameters.iter().map(Parameters::quantise).collect();
    let models: Vec<GridFit> = stored.iter().map(|w| GridFit::new(w, scale).unwrap()).collect();
    let units = f32::from(scale.units_per_em());
    let (glyphs, parameters): (Vec<GlyphSamples>, Vec<Parameters>) =
        glyphs.iter().zip(&parameters).map(|(s, p)| with_larger_sizes(s, p, units).unwrap()).unzip();
    let glyphs: Vec<GlyphSamples> =
        glyphs.iter().zip(&stored).map(|(s, w)| twin_samples(s, w, scale)).collect();
    let extent = Extent::of(&parameters, glyphs[0].sizes.len());
    assert!(extent.sizes > scale.sizes(), "unhinted sizes are evaluated, too");
    let mask = TrainedMask::new(scale.sizes(), extent, &device);
    let weights =
        ParameterTensors::from_parameters(&parameters, extent, &device).rounded(&mask).ordered(extent);
    let (mut largest, mut pixels) = (0.0f32, 0);
    for k in 0..GROUPS {
        let group = SizeGroup::new(&glyphs, &parameters, &models, units, extent, k, &device).unwrap();
        let basis = column_basis(&group.columns, &weights.hinted[0], extent);
        let columns = contract(&basis, &group.columns, &weights, extent);
        let coverage = draw(&columns, &group.rows, &weights.hinted[1], &group.samples).coverage;
        let coverage = values(&coverage);
        let target = values(&group.samples.target);
        let mut target = target.iter();
        for &(first, count, each) in &group.samples.runs {
            for (samples, target) in coverage[first..first + count * each].chunks(each).zip(&mut target) {
                let drawn = samples.iter().sum::<f32>() / each as f32;
                largest = largest.max((drawn - target).abs());
                pixels += 1;
            }
        }
    }
    (largest, pixels)
}

#[test]
fn training_evaluates_what_the_twin_does() {
    let (largest, pixels) = largest_difference("agiRW%.", Target::Smooth);
    assert!(pixels > 10_000);
    assert!(largest <= ROUNDING + PRECISION, "{largest}");
}

#[test]
fn training_evaluates_what_the_twin_does_with_a_warp_in_x_too() {
    let (largest, pixels) = largest_difference("agiRW%.", Target::Mono);
    assert!(pixels > 10_000);
    assert!(largest <= ROUNDING + PRECISION, "{largest}");
}

#[test]
fn parameters_are_the_same_after_conversion_to_tensors_and_back() {
    let (glyphs, scale) = glyph_samples("g.W", Target::Mono);
    let mut parameters: Vec<Parameters> = glyphs
        .iter()
        .map(|samples| initial_fit(samples, scale, Target::Mono, Capacity::default(), 1))
        .collect();
    parameters.iter_mut().for_each(deform);
    let before = parameters.clone();
    let extent = Extent::of(&parameters, scale.sizes());
    let weights = ParameterTensors::from_parameters(&parameters, extent, &Device::flex());
    parameters.iter_mut().for_each(|p| *p = Parameters { field: vec![0.0; p.field.len()], ..p.clone() });
    weights.store(&mut parameters, extent);
    assert_eq!(parameters, before);
}
