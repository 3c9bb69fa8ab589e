//! `nfr lab` as a person calls it: every command, for an epoch or two.

use crate::common::{Directory, FONTS, SANS, nfr};

const ROBOTO: [&str; 3] = [
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/Roboto_500Medium.ttf"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/Roboto_600SemiBold.ttf"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/Roboto_700Bold.ttf"),
];
const LABEL: &str = "SMALL SCALE, not the published one";

fn lab(args: &[&str], more: &[&str]) -> crate::common::Run {
    nfr(&[&["lab"], args, more].concat())
}

fn read(directory: &Directory, name: &str) -> String {
    std::fs::read_to_string(directory.name(name)).unwrap()
}

#[test]
fn every_command_has_help() {
    for command in
        ["truth", "implicit", "masked", "grid-fit", "store", "weights", "styles", "device", "report"]
    {
        assert!(lab(&[command, "--help"], &[]).succeeds().stdout.contains("Usage: nfr lab "));
    }
}

#[test]
fn the_truth_is_written_as_pictures_and_a_manifest_and_replaced() {
    let directory = Directory::new();
    let out = directory.name("made/truth");
    for sides in [["--first", "20", "--last", "22"], ["--first", "21", "--last", "21"]] {
        let run = lab(&["truth", SANS, "--set", "abg", "--out", &out], &sides).succeeds();
        assert!(run.stdout.contains("ppem") && run.stdout.contains(&out));
    }
    let manifest: serde_json::Value =
        serde_json::from_str(&read(&directory, "made/truth/manifest.json")).unwrap();
    assert_eq!(manifest["sizes"].as_array().unwrap().len(), 1, "the second truth replaced the first");
    assert!(std::path::Path::new(&directory.name("made/truth/21/u0067.png")).is_file());
    assert!(!std::path::Path::new(&directory.name("made/truth/20")).exists());
}

#[test]
fn wrong_usage_is_told() {
    let out = ["--out", "/nonexistent/never"];
    lab(&["implicit", SANS, "--text", "l", "--scale", "huge"], &out).rejects_usage(&["paper or small"]);
    lab(&["implicit", SANS, "--text", "l", "--without", "hope"], &out)
        .rejects_usage(&["frequencies, memorisation"]);
    lab(&["masked", SANS, "--text", ""], &out).rejects_usage(&["--text"]);
    lab(&["masked", SANS, "--text", "l", "--boxes", "20-64"], &out).rejects_usage(&["64", "20-63"]);
    lab(&["masked", SANS, "--text", "l", "--boxes", "many"], &out).rejects_usage(&["many"]);
    lab(&["truth", SANS, "--first", "30", "--last", "20"], &out).rejects_usage(&["the smallest first"]);
    lab(&["store", SANS, "out.ttf", "--text", "l", "--bits", "7"], &out).rejects_usage(&["16 or 8"]);
    lab(&["implicit", SANS, "--text", "\u{1F600}"], &out).fails_with(&["U+1F600"]);
    lab(&["truth", "/nonexistent.ttf"], &out).fails_with(&["/nonexistent.ttf"]);
    if cfg!(not(feature = "gpu-wgsl")) {
        lab(&["masked", SANS, "--text", "l", "--device", "gpu"], &out).rejects_usage(&["--features gpu"]);
    }
    lab(&["report", "--time-limit", "soon"], &out).rejects_usage(&["no number of minutes"]);
    lab(&["report", "--time-limit", "1e40"], &out).rejects_usage(&["no time that can pass"]);
    lab(&["report", "--share", "3/2"], &out).rejects_usage(&["2/3, the second of three"]);
    lab(&["report", "--merge", "/nonexistent"], &out)
        .fails_with(&["/nonexistent", "no directory of results"]);
    lab(&["report", "--beside", "/nonexistent"], &out)
        .fails_with(&["/nonexistent/claims.csv", "report's directory"]);
    lab(&["device", SANS, "--text", "l", "--box", "21"], &out).rejects_usage(&["no box of 21 pixels"]);
}

#[test]
fn trainings_leave_history_errors_and_settings_and_are_gone_on_with_only_when_asked() {
    let directory = Directory::new();
    let out = directory.name("out");
    let more = ["--out", &out, "--epochs", "15", "--text", "l", "--quiet"];
    for command in ["implicit", "masked"] {
        let first = lab(&[command, SANS], &more).succeeds();
        assert!(first.stdout.starts_with(LABEL) && first.stdout.contains("mse"));
        lab(&[command, SANS], &more).fails_with(&["--resume", "holds a training"]);
        let place = format!("out/{command}/LiberationSans-Regular/u006c");
        let history = read(&directory, &format!("{place}/history.csv"));
        assert!(history.starts_with(&format!("# {LABEL}")) && history.lines().count() == 2 + 15);
        assert!(history.lines().filter(|line| line.ends_with(",1")).count() >= 1, "resets are marked");
        assert!(read(&directory, &format!("{place}/errors.csv")).contains("U+006C,20,"));
        assert!(read(&directory, &format!("{place}/loss.svg")).contains(LABEL));
        assert!(std::path::Path::new(&directory.name(&format!("{place}/comparison.png"))).is_file());
        let again = lab(&[command, SANS, "--resume"], &more).succeeds();
        assert_eq!(again.stdout, first.stdout, "nothing was trained again");
    }
    assert!(
        lab(&["implicit", SANS, "--resume"], &more)
            .succeeds()
            .stdout
            .contains("4080 pixels in a wrong class")
    );
    let settings: serde_json::Value = serde_json::from_str(&read(&directory, "out/settings.json")).unwrap();
    assert_eq!((&settings["scale"], &settings["implicit_epochs"]), (&"small".into(), &15.into()));
}

#[test]
fn our_own_model_is_trained_on_the_same_bitmaps() {
    let directory = Directory::new();
    let out = directory.name("out");
    let args = ["grid-fit", SANS, "--text", "l", "--boxes", "20,24", "--out", &out, "--quiet"];
    let run = lab(&args, &[]).succeeds();
    assert!(run.stdout.starts_with(LABEL) && run.stdout.contains(" bytes") && !run.stdout.contains("loss"));
    let errors = read(&directory, "out/grid-fit/LiberationSans-Regular/u006c/errors.csv");
    let worst =
        errors.lines().skip(2).filter_map(|line| line.split(',').nth(5)?.parse().ok()).fold(0.0, f64::max);
    assert!(worst > 0.0 && worst < 1e-3, "{errors}");
    assert!(
        !std::path::Path::new(&directory.name("out/grid-fit/LiberationSans-Regular/u006c/loss.svg")).exists()
    );
}

#[test]
fn boxes_and_epochs_other_than_the_scales_are_told() {
    let directory = Directory::new();
    let out = directory.name("out");
    let fewer = ["--scale", "paper", "--boxes", "20,22-26:4", "--epochs", "1", "--out", &out, "--quiet"];
    let run = lab(&["masked", SANS, "--text", "l"], &fewer).succeeds();
    assert!(run.stdout.starts_with("PUBLISHED WIDTHS, not the published sizes and epochs: 3 sizes"));
    let errors = read(&directory, "out/masked/LiberationSans-Regular/u006c/errors.csv");
    let sides: Vec<&str> = errors.lines().skip(2).filter_map(|line| line.split(',').nth(3)).collect();
    assert_eq!(sides, ["20", "22", "26"], "{errors}");
}

#[test]
fn a_network_is_stored_in_a_font_that_draws_it() {
    let directory = Directory::new();
    let (out, font) = (directory.name("out"), directory.name("network.ttf"));
    let args =
        ["store", SANS, &font, "--text", "l", "--bits", "8", "--epochs", "2", "--out", &out, "--quiet"];
    let run = lab(&args, &[]).succeeds();
    assert!(run.stdout.contains("8 bits") && run.stdout.contains("bytes"));
    assert!(nfr(&["info", &font]).succeeds().stdout.contains("network"));
    let drawn = nfr(&["render", &font, "--text", "l", "--ppem", "19", "--json"]).succeeds().stdout;
    assert!(drawn.contains("\"ppem\":19"));
}

#[test]
fn a_family_is_drawn_between_its_weights() {
    let directory = Directory::new();
    let out = directory.name("out");
    let more = ["--text", "l", "--epochs", "1", "--out", &out, "--quiet"];
    let [medium, semi, bold] = ROBOTO;
    let run = lab(&["weights", medium, bold, "--between", semi], &more).succeeds();
    assert!(run.stdout.starts_with(LABEL) && run.stdout.contains("grid-fit snapped"));
    assert!(read(&directory, "out/weights/u006c/errors.csv").contains("Roboto_600SemiBold"));
    lab(&["weights", bold, medium, "--between", semi], &more).fails_with(&["from light to bold"]);
    let styles = lab(&["styles", medium, SANS], &more).succeeds();
    assert!(styles.stdout.contains("no truth"));
}

#[test]
fn the_report_shows_every_chart_and_picture_that_it_names() {
    let directory = Directory::new();
    let out = directory.name("out");
    let args = [
        "report", "--fonts", FONTS, "--text", "la", "--part", "la", "--epochs", "1", "--out", &out, "--quiet",
    ];
    let run = lab(&args, &[]).succeeds();
    assert!(run.stdout.starts_with(LABEL) && run.stdout.contains("index.html"));
    let page = read(&directory, "out/report/index.html");
    assert!(page.contains(LABEL) && page.contains("does not hold"));
    let sources: Vec<&str> = page.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(sources.len() >= 15, "{sources:?}");
    for source in sources {
        assert!(std::path::Path::new(&directory.name(&format!("out/report/{source}"))).is_file(), "{source}");
    }
    for table in ["errors", "ablations", "weights", "resizing", "unhinted", "stored", "trainings", "claims"] {
        assert!(
            read(&directory, &format!("out/report/{table}.csv")).starts_with(&format!("# {LABEL}")),
            "{table}"
        );
    }
}

/// The queue of two characters: 3 fonts × 2 × 2 networks, 4 ablations, 1 weight and 1 pair of typefaces.
const JOBS: usize = 18;

#[test]
fn a_queue_stops_goes_on_is_divided_and_merged() {
    let directory = Directory::new();
    let (first, second, whole) = (directory.name("first"), directory.name("second"), directory.name("whole"));
    let queue = |out: &str, more: &[&str]| {
        let args = [
            "report",
            "--fonts",
            FONTS,
            "--text",
            "la",
            "--part",
            "la",
            "--ablated",
            "l",
            "--weighted",
            "a",
            "--epochs",
            "2",
            "--boxes",
            "20,24",
            "--out",
            out,
            "--quiet",
        ];
        lab(&args, more)
    };
    let none = queue(&first, &["--time-limit", "0", "--train-only"]).succeeds().stdout;
    assert!(none.contains(&format!("0 of {JOBS} trainings are finished; go on with --resume")), "{none}");
    let half = queue(&first, &["--share", "1/2", "--train-only"]).succeeds().stdout;
    assert!(half.contains("9 of 9 trainings are finished\n"), "{half}");
    queue(&first, &["--share", "1/2", "--train-only"]).fails_with(&["--resume"]);
    let other = queue(&second, &["--share", "2/2", "--train-only"]).succeeds().stdout;
    assert!(other.contains("9 of 9 trainings are finished\n"), "{other}");
    // Nothing is trained any more: what the second run lacks comes from the first.
    let page = queue(&second, &["--resume", "--time-limit", "0", "--merge", &first]).succeeds().stdout;
    assert!(page.contains(&format!("{JOBS} of {JOBS} trainings are finished\n")), "{page}");
    queue(&whole, &["--beside", &format!("{second}/report")]).succeeds();
    for table in ["errors", "ablations", "weights", "styles"] {
        let [merged, whole] =
            ["second", "whole"].map(|run| read(&directory, &format!("{run}/report/{table}.csv")));
        assert!(merged.lines().count() > 5 && merged == whole, "{table}: {merged}{whole}");
    }
    let claims = read(&directory, "whole/report/claims.csv");
    assert!(claims.lines().nth(1).unwrap().contains("measured at SMALL SCALE"), "{claims}");
    // A damaged result stops the queue; it is not taken for an unfinished training.
    let result = directory.name("second/masked/LiberationSerif-Regular/u006c/result");
    std::fs::write(&result, b"nonsense").unwrap();
    queue(&second, &["--resume", "--train-only"])
        .fails_with(&["masked/LiberationSerif-Regular/u006c/result", "damaged"]);
}

/// A limit to the size of files, in blocks of the shell's, stands for a full disk: writing fails in the middle of a file.
#[cfg(unix)]
#[test]
fn a_queue_stops_at_a_full_disk_and_goes_on_when_there_is_room() {
    let directory = Directory::new();
    let queue = |out: &str, blocks: &str| {
        let shell = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let mut command = std::process::Command::new("sh");
        command.args(["-c", &shell, "sh"]).arg(assert_cmd::cargo::cargo_bin("nfr"));
        command.args([
            "lab",
            "report",
            "--fonts",
            FONTS,
            "--text",
            "l",
            "--part",
            "l",
            "--networks",
            "masked",
        ]);
        command.args([
            "--epochs",
            "2",
            "--boxes",
            "20,24",
            "--quiet",
            "--resume",
            "--train-only",
            "--out",
            out,
        ]);
        let output = command.output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stdout).unwrap(),
            String::from_utf8(output.stderr).unwrap(),
        )
    };
    let out = directory.name("out");
    let place = "masked/LiberationSerif-Regular/u006c";
    for blocks in ["0", "20"] {
        let (code, printed, error) = queue(&out, blocks);
        assert_eq!((code, printed.as_str(), error.lines().count()), (Some(1), "", 1), "{error}");
        for part in ["error: cannot write ", &format!("{place}/checkpoint ("), "make room there", "--resume"]
        {
            assert!(error.contains(part), "{part:?} is not in {error}");
        }
        let left = std::fs::read_dir(directory.path(&format!("out/{place}"))).unwrap().count();
        assert_eq!(left, 0, "a part of a file is left");
    }
    let (code, printed, error) = queue(&out, "unlimited");
    assert_eq!(code, Some(0), "{error}");
    assert!(printed.contains("3 of 3 trainings are finished\n"), "{printed}");
}

#[test]
fn a_queue_of_one_kind_of_networks_trains_several_in_lockstep() {
    let directory = Directory::new();
    let out = directory.name("out");
    let args =
        ["report", "--fonts", FONTS, "--text", "la", "--part", "la", "--ablated", "l", "--weighted", "a"];
    let more = ["--epochs", "2", "--boxes", "20,24", "--out", &out, "--quiet", "--resume", "--train-only"];
    let queue = |which: &[&str]| lab(&args, &[&more[..], which].concat()).succeeds().stdout;
    let masked = queue(&["--networks", "masked"]);
    assert!(masked.contains("6 of 6 trainings are finished\n"), "{masked}");
    // Of the 12 implicit ones, 9 are of one glyph and of batches of one bitmap: two times four, and one.
    let implicit = queue(&["--networks", "implicit", "--together", "4", "--jobs", "1"]);
    assert!(implicit.contains("12 of 12 trainings are finished\n"), "{implicit}");
    let page = lab(&args, &[&more[..8], &["--time-limit", "0"]].concat()).succeeds().stdout;
    assert!(page.contains(&format!("{JOBS} of {JOBS} trainings are finished\n")), "{page}");
    let trainings = read(&directory, "out/report/trainings.csv");
    let together: Vec<&str> = trainings.lines().skip(2).map(|line| line.split(',').nth(6).unwrap()).collect();
    let count = |networks: &str| together.iter().filter(|of| **of == networks).count();
    // One each of the masked, the ablation without memorisation adaptations, and what is left over.
    assert_eq!((count("4"), count("1")), (8, 8), "{trainings}");
    lab(&args, &["--networks", "both"]).rejects_usage(&["unknown network", "implicit or masked"]);
}

#[test]
fn a_report_of_what_is_finished_says_what_is_not() {
    let directory = Directory::new();
    let out = directory.name("out");
    let args = ["--text", "l", "--epochs", "1", "--boxes", "20,24", "--out", &out, "--quiet"];
    lab(&["masked", concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/LiberationSerif-Regular.ttf")], &args)
        .succeeds();
    let page = ["report", "--fonts", FONTS, "--part", "l", "--resume", "--time-limit", "0"];
    let run = lab(&page, &args).succeeds().stdout;
    assert!(run.contains("1 of 10 trainings are finished; go on with --resume"), "{run}");
    let claims = read(&directory, "out/report/claims.csv");
    assert!(claims.contains("masked one's,not run,–"), "{claims}");
    let trainings = read(&directory, "out/report/trainings.csv");
    assert!(
        trainings.lines().count() == 3 && trainings.contains("masked,LiberationSerif-Regular,U+006C,1,"),
        "{trainings}"
    );
    // Charts of nothing are left out, and the page says of what.
    let page = read(&directory, "out/report/index.html");
    assert!(page.contains("trained on CPU") && page.contains("src=\"loss-masked.svg\""), "{page}");
    for (title, file) in [
        ("The implicit network without its parts", "ablations.svg"),
        ("Between two weights", "weights-u006c.png"),
        ("The network in a font", "histogram-DejaVuSans.svg"),
    ] {
        assert!(page.contains(&format!("<h2>{title}</h2><p>Not run.</p>")), "{title}: {page}");
        assert!(
            !page.contains(file)
                && !std::path::Path::new(&directory.name(&format!("out/report/{file}"))).exists(),
            "{file}"
        );
    }
}

#[test]
fn the_processor_trains_as_itself() {
    let directory = Directory::new();
    let out = directory.name("out");
    let args =
        ["device", SANS, "--text", "l", "--boxes", "20,24", "--box", "24", "--steps", "3", "--out", &out];
    let run = lab(&args, &[]).succeeds().stdout;
    for part in
        ["on CPU\n", "24×24 pixels", "TFLOP/s", "implicit network, loss from", "in step 3: 0.000 % apart"]
    {
        assert!(run.contains(part), "{run}");
    }
}

#[test]
fn info_tells_of_networks() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../spec/vectors/network.ttf");
    let font = nfr::Font::new(std::fs::read(path).unwrap()).unwrap();
    let networks = nfr::internals::table(&font).unwrap().network_gids();
    let bytes: usize = networks.map(|gid| font.model_len(gid.into()).unwrap()).sum();
    let text = nfr(&["info", path]).succeeds().stdout;
    for part in ["version   2.1", &format!("2, {bytes} bytes, weights of 8 bits"), "2 of 3 have models"] {
        assert!(text.contains(part), "{text}");
    }
    let json = nfr(&["info", "--json", path]).succeeds().stdout;
    for part in ["\"networks\":2", &format!("\"network_bytes\":{bytes}"), "\"network_bits\":[8]"] {
        assert!(json.contains(part), "{json}");
    }
}
