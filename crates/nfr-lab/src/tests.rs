//! The experiments on one glyph and a few epochs.

use std::time::{Duration, Instant};

use burn::tensor::{Device, Tensor};

use super::SquareBitmap;
use super::accelerator::Accelerator;
use super::dataset::Dataset;
use super::evaluation::ClassAccuracy;
use super::experiment::Experiment;
use super::family::{FamilyMember, FamilyTask};
use super::implicit::{Implicit, ImplicitConfig, Statistics, focal_loss};
use super::interpolation::{InterpolationTarget, interpolate, names};
use super::masked::{Enlarged, masked_loss};
use super::memorisation::{implicit, train};
use super::network_variant::{Ablation, NetworkVariant};
use super::samples::{ImplicitSamples, PixelLayout};
use super::settings::{ExperimentScale, Settings};
use super::stored_network::{network_weights, stored_font};
use super::study::store;
use nfr::internals::network::Network;
use nfr::internals::network::Precision;
use nfr_convert::Error;

/// The set of the fit rule in these tests.
const SET: &str = "abcdefghijklmnopqrstuvwxyz";

fn datasets(names: &[&str], sides: &[usize]) -> Vec<Dataset> {
    let read = |name: &&str| {
        let path = format!("{}/../../fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"));
        (path.clone().into(), std::fs::read(path).unwrap())
    };
    Dataset::family(names.iter().map(read).collect(), SET, sides).unwrap()
}

fn serif(sides: &[usize]) -> Dataset {
    datasets(&["LiberationSerif-Regular"], sides).remove(0)
}

fn small(epochs: usize) -> Settings {
    let scale = Settings::new(ExperimentScale::Small);
    let narrow = |config| ImplicitConfig { width: 48, latent: 8, encoder: 16, ..config };
    Settings {
        implicit: narrow(scale.implicit),
        family: narrow(scale.family),
        implicit_epochs: epochs,
        masked_widths: vec![64, 32, 64],
        masked_epochs: epochs,
        masked_period: epochs.div_ceil(32),
        ..scale
    }
}

fn context<'b>(settings: Settings, directory: Option<&std::path::Path>, resume: bool) -> Experiment<'b> {
    Experiment {
        settings,
        accelerator: Accelerator::processor(),
        jobs: 2,
        together: 1,
        directory: directory.map(Into::into),
        resume,
        merged: Vec::new(),
        deadline: None,
        unfinished: false,
        keep_networks: true,
        on_progress: &|_, _, _| (),
    }
}

fn values<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().unwrap()
}

#[test]
fn the_focal_loss_is_that_worked_out_by_hand() {
    let device = Device::flex();
    // The softmax of (0, 0) is ½: (½)⁶ · ln 2. That of (ln 3, 0) is ¾ and ¼: (¼)⁶ · ln(4/3), (¾)⁶ · ln 4.
    let loss = |scores: [f32; 2], classes: [f32; 2]| {
        let [scores, classes] = [scores, classes].map(|row| Tensor::<2>::from_floats([row], &device));
        values(focal_loss(scores, classes, None))[0]
    };
    let ln3 = 3f32.ln();
    let cases = [
        (loss([0.0, 0.0], [1.0, 0.0]), 2f32.ln() / 64.0),
        (loss([ln3, 0.0], [1.0, 0.0]), (4f32 / 3.0).ln() / 4096.0),
        (loss([ln3, 0.0], [0.0, 1.0]), 729.0 / 4096.0 * 4f32.ln()),
        // Clipped at a millionth.
        (loss([0.0, 100.0], [1.0, 0.0]), 1e6f32.ln()),
    ];
    for (loss, expected) in cases {
        assert!((loss / expected - 1.0).abs() < 1e-4, "{loss} for {expected}");
    }
    let scores = Tensor::<2>::from_floats([[0.0, 0.0], [ln3, 0.0]], &device);
    let both =
        values(focal_loss(scores, Tensor::<2>::from_floats([[1.0, 0.0], [1.0, 0.0]], &device), None))[0];
    assert!((both - (cases[0].1 + cases[1].1) / 2.0).abs() < 1e-6, "the mean over pixels");
}

#[test]
fn the_masked_loss_counts_original_pixels_alone() {
    let device = Device::flex();
    let tensor = |rows: [[f32; 4]; 2]| Tensor::<2>::from_floats(rows, &device);
    let truth = Enlarged {
        sizes: Tensor::<2>::from_floats([[1.0, 0.0], [0.0, 1.0]], &device),
        coverage: tensor([[0.0, 1.0, 0.0, 1.0], [0.0; 4]]),
        mask: tensor([[1.0, 0.0, 0.0, 1.0], [1.0; 4]]),
    };
    // Off by ½ at a pixel that counts, by 1 at one that does not, by 1 at another: 1.25 over 6 pixels and 2 bitmaps.
    let predicted = tensor([[0.5, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]]);
    assert!((values(masked_loss(predicted, &truth))[0] - 1.25 / 12.0).abs() < 1e-6);
}

/// The mean squared error that both networks have to reach.
const MEMORISED: f64 = 0.0005;

#[test]
fn each_network_memorises_a_glyph_at_two_sizes() {
    let dataset = serif(&[20, 26]);
    let glyph = dataset.glyphs("l").unwrap()[0];
    let context = context(small(800), None, false);
    for model in [NetworkVariant::Implicit(Vec::new()), NetworkVariant::Masked] {
        let evaluation = train(&context, &dataset, glyph, &model).unwrap();
        assert!(evaluation.mse() < MEMORISED, "{}: {}", evaluation.model, evaluation.mse());
        assert!(evaluation.history.len() == 800 && evaluation.rows.len() == 2);
        let Some(class_accuracy) = evaluation.class_accuracy else {
            assert_eq!(model, NetworkVariant::Masked);
            continue;
        };
        assert_eq!(class_accuracy.pixels, 20 * 20 + 26 * 26);
        assert!(
            class_accuracy.wrong > 0 || (evaluation.mse() - class_accuracy.rounding).abs() < 1e-9,
            "{class_accuracy:?}"
        );
    }
}

#[test]
fn choices_are_counted_against_the_classes_below_the_truth() {
    let square = |pixels: &[u8]| SquareBitmap { side: 2, pixels: pixels.to_vec() };
    // 127 is in the class of 45 %, which is drawn as 115; the others stand for their classes.
    let truth = [square(&[0, 255, 127, 26]), square(&[0, 0, 0, 255])];
    let class_accuracy =
        ClassAccuracy::new(&truth, &[square(&[0, 255, 115, 13]), square(&[0, 0, 13, 255])]).unwrap();
    assert_eq!((class_accuracy.pixels, class_accuracy.wrong), (8, 2));
    let of_level = |levels: f64| (levels / 255.0).powi(2) / 4.0 / 2.0;
    assert!((class_accuracy.rounding - of_level(12.0)).abs() < 1e-12);
    assert!((class_accuracy.mse - 2.0 * of_level(13.0)).abs() < 1e-12);
}

#[test]
fn every_ablation_trains_and_leaves_out_what_it_says() {
    let dataset = serif(&[20, 24, 28, 32]);
    let glyph = dataset.glyphs("a").unwrap()[0];
    let context = context(small(2), None, false);
    let parameters = |config| Implicit::parameters(config);
    let whole = context.settings.implicit;
    for part in Ablation::ALL {
        let (evaluation, network) = implicit(&context, &dataset, glyph, &[part]).unwrap();
        assert_eq!(evaluation.model, format!("implicit without {}", part.name()));
        assert!(evaluation.history.iter().all(|epoch| epoch.loss.is_finite()));
        use burn::module::Module;
        let config = part.apply(whole);
        // The running statistics of batch normalisation are numbers, but not parameters.
        assert_eq!(network.num_params(), parameters(config) + 3 * 2 * config.width);
        let fewer = matches!(part, Ablation::Frequencies | Ablation::Size);
        assert_eq!(parameters(config) < parameters(whole), fewer, "{part:?}");
    }
    // 11 layers 784 wide, the first for 130 numbers, 21 classes, three normalisations: 25 MB, 24 MiB.
    let published = 131 * 784 + 10 * 785 * 784 + 785 * 21 + 3 * 2 * 784;
    assert_eq!(
        parameters(ImplicitConfig { size: false, ..Settings::new(ExperimentScale::Paper).implicit }),
        published
    );
}

#[test]
fn pixels_in_groups_train_as_those_in_one() {
    let dataset = serif(&[20, 26, 40]);
    let samples = dataset.samples(dataset.glyphs("a").unwrap()[0].1, None).unwrap();
    let (settings, device) = (small(1), Device::flex().autodiff());
    let train = |layout: PixelLayout| {
        let set = ImplicitSamples::new(samples.clone(), 3, settings.implicit, layout, &device);
        let network = Implicit::new(settings.implicit, 1, &device);
        // At a low rate, so that rounding is not magnified from step to step.
        let steps = (0..12).map(|step| set.batch(&[step % 3]));
        let (training, losses) = super::train::Training::new(network).steps(1e-5, steps).unwrap();
        let scores = training.network.forward(&set.batch(&[1]).0, Statistics::Batch);
        (losses, super::samples::likeliest(scores, 26).unwrap())
    };
    // 400 pixels are less than a group of 512, 676 and 1600 more than one and three.
    let ((whole, drawn), (groups, in_groups)) = (train(PixelLayout::Whole), train(PixelLayout::Groups));
    for (whole, groups) in whole.iter().zip(&groups) {
        assert!((whole / groups - 1.0).abs() < 1e-4, "{whole} {groups}");
    }
    assert!(whole[0] > whole[9], "the loss falls");
    assert_eq!(drawn.pixels.len(), 26 * 26);
    let other = drawn.pixels.iter().zip(&in_groups.pixels).filter(|(a, b)| a != b).count();
    assert!(other <= 2, "{other} pixels");
}

#[test]
fn a_training_that_was_interrupted_ends_as_one_that_was_not() {
    let dataset = serif(&[20, 26]);
    let glyph = dataset.glyphs("l").unwrap()[0];
    let directory = tempfile::tempdir().unwrap();
    let whole =
        train(&context(small(6), None, false), &dataset, glyph, &NetworkVariant::Implicit(Vec::new()))
            .unwrap();
    // Stopped after four epochs by a full disk, say: what it had saved is what a schedule of six has after four.
    let stopped = std::cell::Cell::new(0);
    let settings = small(6);
    let schedule = settings.implicit_schedule(settings.implicit);
    let set = ImplicitSamples::new(
        dataset.samples(glyph.1, None).unwrap(),
        2,
        settings.implicit,
        PixelLayout::Whole,
        &Device::flex().autodiff(),
    );
    let checkpoint = || super::train::checkpoint::Checkpoint::new(directory.path().join("checkpoint"), 7);
    let network = || Implicit::new(settings.implicit, schedule.seed, &Device::flex().autodiff());
    let first = super::train::Training::new(network());
    let result = first.train(
        &schedule,
        set.len(),
        |numbers| set.batch(numbers),
        |run| {
            checkpoint().save(run)?;
            stopped.set(stopped.get() + 1);
            if stopped.get() == 4 { Err(Error::Io("stopped".into())) } else { Ok(true) }
        },
    );
    assert!(result.is_err());
    let resumed = checkpoint().begin(network()).unwrap();
    assert_eq!(resumed.epochs(), 4);
    let resumed = resumed.train(&schedule, set.len(), |numbers| set.batch(numbers), |_| Ok(true)).unwrap();
    let losses = |history: &[super::train::Epoch]| history.iter().map(|epoch| epoch.loss).collect::<Vec<_>>();
    assert_eq!(losses(&resumed.histories[0]), losses(&whole.history));
    let scores = |network: &Implicit| values(network.forward(&set.batch(&[0]).0, Statistics::Batch));
    let (_, straight) = implicit(&context(small(6), None, false), &dataset, glyph, &[]).unwrap();
    assert_eq!(scores(&resumed.network), scores(&straight));
}

#[test]
fn a_training_whose_time_is_up_leaves_what_it_has_come_to_and_goes_on() {
    let dataset = serif(&[20]);
    let glyph = dataset.glyphs("l").unwrap()[0];
    let directory = tempfile::tempdir().unwrap();
    let model = NetworkVariant::Masked;
    let run = |deadline: Option<Duration>, unfinished: bool| {
        let deadline = deadline.map(|time| Instant::now() + time);
        let context =
            Experiment { deadline, unfinished, ..context(small(3000), Some(directory.path()), true) };
        train(&context, &dataset, glyph, &model)
    };
    let late = Some(Duration::ZERO);
    assert!(matches!(run(late, true), Err(Error::TimeLimit)), "nothing is there yet");
    assert!(matches!(run(Some(Duration::from_millis(300)), false), Err(Error::TimeLimit)));
    let so_far = run(late, true).unwrap();
    assert!((1..3000).contains(&so_far.history.len()) && so_far.drawn.len() == 1);
    assert!(matches!(run(late, false), Err(Error::TimeLimit)), "it is taken only where it is asked for");
    let whole = run(None, false).unwrap();
    assert_eq!(whole.history[..so_far.history.len()], so_far.history, "it went on from there");
    assert_eq!(whole.history.len(), 3000);
    let left: Vec<_> = std::fs::read_dir(directory.path().join("masked/LiberationSerif-Regular/u006c"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name == "unfinished")
        .collect();
    assert!(left.is_empty());
    assert_eq!(run(late, true).unwrap().rows, whole.rows);
}

#[test]
fn a_checkpoint_of_something_else_or_a_damaged_one_is_refused_and_kept() {
    let dataset = serif(&[20, 26]);
    let glyph = dataset.glyphs("l").unwrap()[0];
    let directory = tempfile::tempdir().unwrap();
    let run = |settings: Settings, resume| {
        let context = context(settings, Some(directory.path()), resume);
        train(&context, &dataset, glyph, &NetworkVariant::Masked).map(|evaluation| evaluation.rows)
    };
    let rows = run(small(2), false).unwrap();
    let path = directory.path().join("masked/LiberationSerif-Regular/u006c/checkpoint");
    let bytes = std::fs::read(&path).unwrap();
    let refused = |settings, resume, what: &str| {
        let error = run(settings, resume).unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
    };
    refused(small(2), false, "--resume");
    refused(Settings { seed: 2, ..small(2) }, true, "other settings");
    assert_eq!(run(small(2), true).unwrap(), rows, "a finished training is used as it is");
    // With its result the checkpoint is not needed any more.
    std::fs::remove_file(path.with_file_name("result")).unwrap();
    assert_eq!(run(small(2), true).unwrap(), rows, "a finished network draws again");
    std::fs::remove_file(path.with_file_name("result")).unwrap();
    for at in [0, 12, 40, bytes.len() / 2, bytes.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1;
        std::fs::write(&path, &damaged).unwrap();
        refused(small(2), true, "damaged");
        std::fs::write(&path, &bytes[..at]).unwrap();
        refused(small(2), true, "damaged");
    }
    assert_eq!(std::fs::read(&path).unwrap().len(), bytes.len() - 1, "the file is kept");
}

#[test]
fn a_network_in_a_font_draws_what_it_drew_in_training() {
    let dataset = serif(&[20, 26, 32]);
    let glyph = dataset.glyphs("l").unwrap()[0];
    let context = context(small(60), None, false);
    let (evaluation, network) = implicit(&context, &dataset, glyph, &[]).unwrap();
    let stored = network_weights(&network, context.settings.implicit, &dataset, glyph).unwrap();
    let evaluated = Network::new(stored.clone()).unwrap();
    for (k, drawn) in evaluation.drawn.iter().enumerate() {
        let pixels = evaluated.coverage(k).unwrap();
        let other = pixels.iter().zip(&drawn.pixels).filter(|(a, b)| a != b).count();
        // Sums in another order round differently, which can tip a pixel between two classes.
        assert!(other <= pixels.len() / 200, "{other} of {} pixels at size {k}", pixels.len());
    }
    let [sixteen, eight] = store(&context, &dataset, glyph, &network, &evaluation).unwrap();
    assert!(sixteen.bytes > eight.bytes && eight.bytes > Implicit::parameters(context.settings.implicit));
    for (stored, bound) in [(&sixteen, 0.001), (&eight, 0.01)] {
        let (mse, before) = (stored.evaluation.mse(), stored.mse_before);
        assert!((mse - before).abs() < bound, "{mse} for {before} at {} bits", stored.bits);
    }
    let file = stored_font(&dataset, &[(glyph, stored)], Precision::Eight, 1).unwrap();
    assert!(nfr::internals::table(&nfr::Font::new(file).unwrap()).unwrap().is_network(glyph.1.into()));
    let conditioned = ImplicitConfig { weight: true, ..context.settings.implicit };
    assert!(matches!(super::stored_network::architecture(conditioned), Err(Error::Unsupported(_))));
}

#[test]
fn between_two_weights_our_model_is_nearer_to_the_real_one_than_either_end() {
    let family = datasets(&["Roboto_500Medium", "Roboto_700Bold", "Roboto_600SemiBold"], &[32, 62]);
    let [medium, bold, between] = &family[..] else { panic!("three fonts") };
    assert!(family.windows(2).all(|pair| pair[0].truth.sizes == pair[1].truth.sizes), "common sizes");
    let members =
        [FamilyMember { dataset: medium, weight: 0.5 }, FamilyMember { dataset: bold, weight: 0.7 }];
    let target = InterpolationTarget { name: &between.name, share: 0.5, real: Some(between) };
    let found = interpolate(&context(small(2), None, false), "weights", &members, target, 'a').unwrap();
    let mse =
        |name: &str| found.between.iter().find(|rendering| rendering.name == name).unwrap().mse().unwrap();
    let ends = mse(names::FIRST).min(mse(names::LAST));
    assert!(mse(names::GRID_FIT) < ends, "{} {ends}", mse(names::GRID_FIT));
    assert!(mse(names::IMPLICIT).is_finite() && found.ends.len() == 2);
}

#[test]
fn at_its_ends_a_family_is_its_members() {
    let family = datasets(&["LiberationSerif-Regular", "LiberationSans-Regular"], &[20, 24]);
    let members = [
        FamilyMember { dataset: &family[0], weight: -1.0 },
        FamilyMember { dataset: &family[1], weight: 1.0 },
    ];
    let context = context(small(3), None, false);
    let trained = FamilyTask::new(&context, "styles", &members, 0.5, 'l').unwrap().train(None).unwrap();
    let [first, last] = [0, 1].map(|number| trained.member(number).unwrap());
    assert_eq!(trained.between(0, 1, 0.0).unwrap(), first);
    assert_eq!(trained.between(0, 1, 1.0).unwrap(), last);
    assert_ne!(first, last);
}
