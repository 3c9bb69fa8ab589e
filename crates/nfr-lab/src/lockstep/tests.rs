use burn::tensor::Device;

use super::*;
use crate::accelerator::Accelerator;
use crate::dataset::Dataset;
use crate::experiment::Experiment;
use crate::memorisation::{Member, is_waiting, kept, train_together, trained};
use crate::network_training::{TrainedNetwork, TrainingRun, train_implicit};
use crate::network_variant::{Ablation, NetworkVariant};
use crate::samples::{PixelLayout, TrainingSample};
use crate::settings::{ExperimentScale, Settings};
use crate::train::TrainingSchedule;
use crate::train::result::TrainingResult;

fn config() -> ImplicitConfig {
    let small = Settings::new(ExperimentScale::Small).implicit;
    ImplicitConfig { width: 24, latent: 8, encoder: 16, ..small }
}

fn samples(glyph: &str) -> Vec<TrainingSample> {
    let path = format!("{}/../../fonts/LiberationSerif-Regular.ttf", env!("CARGO_MANIFEST_DIR"));
    let dataset = Dataset::open(path.clone().into(), std::fs::read(path).unwrap(), "alg", &[20, 23]).unwrap();
    dataset.samples(dataset.glyphs(glyph).unwrap()[0].1, None).unwrap()
}

fn run(device: &Device) -> TrainingRun<'_> {
    let on_epoch = &|_: usize| ();
    TrainingRun { device, layout: PixelLayout::Whole, checkpoint: None, deadline: None, on_epoch }
}

#[test]
fn networks_in_lockstep_learn_as_each_does_alone() {
    let device = Device::flex().autodiff();
    // At a low rate, so that rounding is not magnified from step to step.
    let schedule = TrainingSchedule { rates: vec![1e-5; 6], batch: 1, seed: 3 };
    let without = [Ablation::Frequencies, Ablation::Residuals, Ablation::Size];
    let mut members = vec![(samples("l"), config()), (samples("a"), config())];
    members.extend(without.map(|part| (samples("g"), part.apply(config()))));
    let together = train_in_lockstep(&members, &schedule, run(&device)).unwrap();
    assert_eq!(together.len(), members.len());
    for (k, ((samples, config), together)) in members.iter().zip(&together).enumerate() {
        let alone: TrainedNetwork<Implicit> =
            train_implicit(samples.clone(), 2, *config, &schedule, run(&device)).unwrap();
        assert_eq!(together.operations, alone.operations, "network {k}");
        assert!(alone.history[0].loss > alone.history[5].loss, "the loss of network {k} falls");
        for (a, b) in together.history.iter().zip(&alone.history) {
            assert!((a.loss / b.loss - 1.0).abs() < 1e-4, "network {k}: {a:?} {b:?}");
        }
        let pixels = |one: &TrainedNetwork<Implicit>| {
            one.drawn.iter().flat_map(|square| square.pixels.clone()).collect::<Vec<u8>>()
        };
        let differing = pixels(together).iter().zip(pixels(&alone)).filter(|(a, b)| **a != *b).count();
        assert!(differing <= 4, "{differing} pixels of network {k}");
        // By itself it computes what it computed among the others.
        let set =
            crate::samples::ImplicitSamples::new(samples.clone(), 2, *config, PixelLayout::Whole, &device);
        let scores = together.network.forward(&set.batch(&[1]).0, crate::implicit::Statistics::Batch);
        let drawn = crate::samples::likeliest(scores, 23).unwrap();
        let differing = drawn.pixels.iter().zip(&together.drawn[1].pixels).filter(|(a, b)| a != b).count();
        assert!(differing <= 2, "{differing} pixels of network {k} by itself");
    }
}

#[test]
fn networks_of_other_widths_batches_or_conditions_do_not_join() {
    let whole = config();
    for part in Ablation::ALL {
        let joins = part != Ablation::Memorisation;
        assert_eq!(
            can_join(&whole, &part.apply(whole)) && can_join(&part.apply(whole), &whole),
            joins,
            "{part:?}"
        );
    }
    let wider = ImplicitConfig { width: 48, ..whole };
    let family = ImplicitConfig { weight: true, ..whole };
    assert!(!can_join(&whole, &wider) && !can_join(&family, &family));
}

#[test]
fn bitmaps_of_different_sizes_are_refused() {
    let device = Device::flex().autodiff();
    let schedule = TrainingSchedule { rates: vec![1e-5], batch: 1, seed: 3 };
    let fewer = samples("l")[..1].to_vec();
    let failed = train_in_lockstep(&[(samples("a"), config()), (fewer, config())], &schedule, run(&device));
    assert!(matches!(failed, Err(nfr_convert::Error::InvalidParameter(why)) if why.contains("same sizes")));
}

#[test]
fn networks_whose_time_is_up_go_on_together_and_end_as_those_that_were_not_stopped() {
    let path = format!("{}/../../fonts/LiberationSerif-Regular.ttf", env!("CARGO_MANIFEST_DIR"));
    let dataset = Dataset::open(path.clone().into(), std::fs::read(path).unwrap(), "alg", &[20]).unwrap();
    let member = |glyph: &str, keep_network: bool| Member {
        dataset: &dataset,
        glyph: dataset.glyphs(glyph).unwrap()[0],
        model: NetworkVariant::Implicit(Vec::new()),
        keep_network,
    };
    let members = [member("a", true), member("l", false)];
    let [stopped, straight] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let epochs = 60;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let progress = |_: &str, epoch: usize, _: usize| done.store(epoch, std::sync::atomic::Ordering::Relaxed);
    let context = |directory: &std::path::Path, deadline: Option<std::time::Instant>| Experiment {
        settings: Settings {
            implicit: config(),
            implicit_epochs: epochs,
            sides: vec![20],
            ..Settings::new(ExperimentScale::Small)
        },
        accelerator: Accelerator::processor(),
        jobs: 1,
        together: 2,
        directory: Some(directory.into()),
        resume: true,
        merged: Vec::new(),
        deadline,
        unfinished: false,
        keep_networks: true,
        on_progress: &progress,
    };
    let soon = || Some(std::time::Instant::now() + std::time::Duration::from_millis(1));
    while !train_together(&context(stopped.path(), soon()), &members).unwrap() {
        assert!(is_waiting(&context(stopped.path(), None), &members[0]).unwrap());
        let left = stopped.path().join("implicit/LiberationSerif-Regular/u0061/unfinished");
        assert!(done.load(std::sync::atomic::Ordering::Relaxed) == 0 || left.exists());
    }
    assert!(train_together(&context(straight.path(), None), &members).unwrap());
    for member in &members {
        let result = |directory: &std::path::Path| {
            let late = Some(std::time::Instant::now());
            trained(&context(directory, late), member.dataset, member.glyph, &member.model).unwrap()
        };
        let (a, b) = (result(stopped.path()), result(straight.path()));
        let losses = |one: &TrainingResult| one.history.iter().map(|epoch| epoch.loss).collect::<Vec<_>>();
        assert_eq!((losses(&a), &a.drawn), (losses(&b), &b.drawn));
        assert_eq!((a.history.len(), a.origin.together), (epochs, 2));
        assert!(!is_waiting(&context(stopped.path(), None), member).unwrap());
        let network = kept(&context(stopped.path(), None), member.dataset, member.glyph).unwrap();
        assert_eq!(network.is_some(), member.keep_network);
        assert!(network.is_none_or(|(evaluation, _)| evaluation.drawn == a.drawn));
    }
    assert!(stopped.path().join("together").read_dir().unwrap().next().is_none());
}
