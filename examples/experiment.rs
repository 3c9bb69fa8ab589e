//! scratch experiment
#![allow(clippy::all, clippy::pedantic, clippy::print_stdout, clippy::unwrap_used, missing_docs)]
use nfr::convert::{
    start::{Capacity, Draft},
    teach,
    teacher::Teacher,
    train,
};
use nfr::model::gridfit::{GridFit, Scale, Scratch};
use read_fonts::TableProvider;
fn arg(name: &str, default: f64) -> f64 {
    std::env::args()
        .find_map(|a| a.strip_prefix(&format!("{name}=")).map(|v| v.parse().unwrap()))
        .unwrap_or(default)
}
fn entropy(v: impl Iterator<Item = i32>) -> f64 {
    let mut m = std::collections::BTreeMap::new();
    let mut n = 0.0;
    for x in v {
        *m.entry(x).or_insert(0.0) += 1.0;
        n += 1.0;
    }
    m.values().map(|c: &f64| -c * (c / n).log2()).sum::<f64>() / 8.0
}
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let text = std::env::args().nth(2).unwrap();
    let text: String = if text == "ascii" { ('!'..='~').collect() } else { text };
    let data = std::fs::read(path).unwrap();
    let font = read_fonts::FontRef::new(&data).unwrap();
    let teacher = Teacher::new(&font, nfr::Target::Smooth).unwrap();
    let ppem: Vec<u16> = (8..=64).collect();
    let at: Vec<_> = ppem.iter().map(|s| teacher.at(*s).unwrap()).collect();
    let scale = Scale { units_per_em: teacher.units_per_em(), first_ppem: 8, last_ppem: 64 };
    let cap = Capacity {
        cell: arg("cell", 0.034) as f32,
        knots: arg("knots", 12.0) as usize,
        rank: arg("rank", 4.0) as usize,
    };
    let d = train::Schedule::default();
    let sched = train::Schedule {
        steps: arg("steps", d.steps as f64) as usize,
        rounded_from: arg("rounded", d.rounded_from as f64) as f32,
        field_rate: arg("flr", d.field_rate),
        warp_rate: arg("wlr", d.warp_rate),
        pattern_rate: arg("plr", d.pattern_rate),
        embedding_rate: arg("elr", d.embedding_rate),
    };
    let t0 = std::time::Instant::now();
    let cmap = font.cmap().unwrap();
    let lessons: Vec<_> = text
        .chars()
        .map(|c| teach::lesson(&teacher, &at, cmap.map_codepoint(c).unwrap().to_u32() as u16).unwrap())
        .collect();
    let chunk = arg("chunk", 8.0) as usize;
    let mut drafts: Vec<Draft> =
        lessons.iter().map(|l| Draft::from_lesson(l, scale, nfr::Target::Smooth, cap, 1)).collect();
    eprintln!("start {:?}", t0.elapsed());
    let stats = |drafts: &[Draft], show: bool| {
        let (mut n, mut abs, mut bad, mut small, mut sn) = (0usize, 0usize, 0usize, 0usize, 0usize);
        for ((l, d), c) in lessons.iter().zip(drafts).zip(text.chars()) {
            let m = GridFit::new(&d.quantise(), scale).unwrap();
            let mut sc = Scratch::default();
            let (mut gn, mut gabs, mut gbad) = (0usize, 0usize, 0usize);
            for h in &l.sizes {
                let p = m.placement(h.ppem as f32).unwrap();
                let mut px = vec![0u8; p.area()];
                m.draw(h.ppem as f32, p, &mut sc, &mut px);
                let q = h.bitmap.placement;
                let l0 = p.left.min(q.left);
                let r0 = (p.left + p.width as i32).max(q.left + q.width as i32);
                let t0 = p.top.max(q.top);
                let b0 = (p.top - p.height as i32).min(q.top - q.height as i32);
                let at = |pl: nfr::Placement, px: &[u8], x: i32, y: i32| {
                    let (i, j) = (x - pl.left, pl.top - 1 - y);
                    if i >= 0 && j >= 0 && i < pl.width as i32 && j < pl.height as i32 {
                        px[j as usize * pl.width as usize + i as usize] as i32
                    } else {
                        0
                    }
                };
                for y in b0..t0 {
                    for x in l0..r0 {
                        let e = (at(p, &px, x, y) - at(q, &h.bitmap.pixels, x, y)).unsigned_abs() as usize;
                        gn += 1;
                        gabs += e;
                        gbad += (e > 16) as usize;
                        if h.ppem < 16 {
                            small += e;
                            sn += 1;
                        }
                    }
                }
            }
            if show {
                print!(
                    "{c} {:.4} {:.2}%  ",
                    gabs as f64 / gn.max(1) as f64 / 255.0,
                    100.0 * gbad as f64 / gn.max(1) as f64
                );
            }
            n += gn;
            abs += gabs;
            bad += gbad;
        }
        println!(
            "\ntotal mae {:.5} bad16 {:.3}% small {:.5}",
            abs as f64 / n as f64 / 255.0,
            100.0 * bad as f64 / n as f64,
            small as f64 / sn as f64 / 255.0
        );
    };
    stats(&drafts, false);
    if arg("show", 0.0) > 0.0 {
        let s = arg("show", 0.0) as usize;
        let m = GridFit::new(&drafts[0].quantise(), scale).unwrap();
        let mut sc = Scratch::default();
        let p = m.placement(s as f32).unwrap();
        let mut px = vec![0; p.area()];
        m.draw(s as f32, p, &mut sc, &mut px);
        let dump = |p: nfr::Placement, px: &[u8]| {
            println!("{p:?}");
            for r in px.chunks(p.width.max(1) as usize) {
                println!("{}", r.iter().map(|v| format!("{v:4}")).collect::<String>());
            }
        };
        dump(p, &px);
        let b = &lessons[0].sizes[s - 8].bitmap;
        dump(b.placement, &b.pixels);
        println!("{:?}", drafts[0].hinted[1].chunks(drafts[0].knots[1].len()).nth(s - 8));
    }
    let t1 = std::time::Instant::now();
    let jobs = arg("jobs", 2.0) as usize;
    {
        let work: std::sync::Mutex<Vec<_>> =
            std::sync::Mutex::new(lessons.chunks(chunk).zip(drafts.chunks_mut(chunk)).collect());
        std::thread::scope(|s| {
            for _ in 0..jobs {
                s.spawn(|| {
                    loop {
                        let Some((l, d)) = work.lock().unwrap().pop() else { break };
                        train::train(&l.iter().collect::<Vec<_>>(), d, scale, sched, Default::default())
                            .unwrap();
                    }
                });
            }
        });
    }
    println!("train {:?}", t1.elapsed());
    if arg("show2", 0.0) > 0.0 {
        let s = arg("show2", 0.0) as usize;
        let m = GridFit::new(&drafts[0].quantise(), scale).unwrap();
        let mut sc = Scratch::default();
        let p = m.placement(s as f32).unwrap();
        let mut px = vec![0; p.area()];
        m.draw(s as f32, p, &mut sc, &mut px);
        let dump = |p: nfr::Placement, px: &[u8]| {
            println!("{p:?}");
            for r in px.chunks(p.width.max(1) as usize) {
                println!("{}", r.iter().map(|v| format!("{v:4}")).collect::<String>());
            }
        };
        dump(p, &px);
        let b = &lessons[0].sizes[s - 8].bitmap;
        dump(b.placement, &b.pixels);
    }
    stats(&drafts, true);
    let (mut f, mut w, mut p, mut e, mut k) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let z = |v: f64| v / drafts.len() as f64;
    for d in &drafts {
        let q = d.quantise();
        let stride = d.cells[0] + 2;
        let g = |i: usize, j: usize| if i < 9999 && j < 9999 { q.field[j * stride + i] as i32 } else { 0 };
        let rows = d.cells[1] + 2;
        f += entropy((0..rows).flat_map(|j| (0..stride).map(move |i| (i, j))).map(|(i, j)| {
            let a = if i > 0 { g(i - 1, j) } else { 0 };
            let b = if j > 0 { g(i, j - 1) } else { 0 };
            let c = if i > 0 && j > 0 { g(i - 1, j - 1) } else { 0 };
            let pr = a + b - c;
            let pr = pr.clamp(a.min(b), a.max(b));
            g(i, j) - pr
        }));
        let nk = q.warp_y.knots.len();
        k += nk as f64;
        w += entropy(q.warp_y.hinted.iter().enumerate().map(|(i, h)| {
            let s = 8 + i / nk;
            let kn = q.warp_y.knots[i % nk] as f32 / 2048.0;
            h - 32 * (kn * s as f32).round() as i32
        }));
        p += entropy(q.patterns.iter().map(|v| *v as i32));
        e += entropy(q.embedding.iter().map(|v| *v as i32));
    }
    if arg("study", 0.0) > 0.0 {
        warp_study(&drafts);
    }
    {
        use nfr::table;
        let models: Vec<_> = drafts
            .iter()
            .enumerate()
            .map(|(i, d)| table::GlyphModel { gid: i as u16, weights: d.quantise() })
            .collect();
        let plain: usize = models.iter().map(|m| table::codec::encode(&m.weights, scale).len()).sum();
        let h = table::Header { first_ppem: 8, last_ppem: 64, ..Default::default() };
        let (t, lens) = table::write(&h, &models, scale).unwrap();
        let tt = table::Table::parse(&t).unwrap();
        let mut dec = table::ModelDecoder::new(&tt).unwrap();
        for m in &models {
            assert_eq!(dec.decode(&tt, m.gid, scale).unwrap(), m.weights);
        }
        println!(
            "table {} bytes = {:.0} per glyph; models {:.0}; plain {}",
            t.len(),
            t.len() as f64 / models.len() as f64,
            lens.iter().sum::<usize>() as f64 / models.len() as f64,
            plain / models.len()
        );
    }
    println!(
        "bytes (order-0, per glyph) field {:.0} warp {:.0} ({:.1} knots) patterns {:.0} embedding {:.0} total {:.0}",
        z(f),
        z(w),
        z(k),
        z(p),
        z(e),
        z(f + w + p + e)
    );
}
#[allow(dead_code)]
fn warp_study(drafts: &[Draft]) {
    // per knot sequences, several predictors; entropies per knot (order-0, own table) and pooled over font
    let n = drafts.len() as f64;
    let names = [
        "round",
        "linear",
        "round(h)+delta prev",
        "disp delta",
        "prev knot + round gap",
        "prev knot + linear gap",
        "best of all per knot (pooled by kind)",
        "interp neighbours",
    ];
    let mut pooled: Vec<Vec<i32>> = vec![vec![]; 8];
    let mut own = [0.0f64; 8];
    for d in drafts {
        let q = d.quantise();
        let nk = q.warp_y.knots.len();
        if nk == 0 {
            continue;
        }
        let h = |s: usize, k: usize| q.warp_y.hinted[s * nk + k];
        let kn = |k: usize| q.warp_y.knots[k] as f32 / 2048.0;
        for k in 0..nk {
            let mut v: Vec<Vec<i32>> = vec![vec![]; 8];
            for s in 0..57 {
                let p = (8 + s) as f32;
                let lin = |k: usize, p: f32| (kn(k) * p * 32.0).round() as i32;
                v[0].push(h(s, k) - 32 * (kn(k) * p).round() as i32);
                v[1].push(h(s, k) - lin(k, p));
                let r = |s: usize| h(s, k) - 32 * (kn(k) * (8 + s) as f32).round() as i32;
                v[2].push(if s > 0 { r(s) - r(s - 1) } else { r(s) });
                let dd = |s: usize| h(s, k) - lin(k, (8 + s) as f32);
                v[3].push(if s > 0 { dd(s) - dd(s - 1) } else { dd(s) });
                v[4].push(if k > 0 {
                    h(s, k) - h(s, k - 1) - 32 * ((kn(k) - kn(k - 1)) * p).round() as i32
                } else {
                    h(s, k) - 32 * (kn(k) * p).round() as i32
                });
                v[5].push(if k > 0 {
                    h(s, k) - h(s, k - 1) - ((kn(k) - kn(k - 1)) * p * 32.0).round() as i32
                } else {
                    h(s, k) - 32 * (kn(k) * p).round() as i32
                });
                v[7].push(if k > 0 && k + 1 < nk {
                    let t = (kn(k) - kn(k - 1)) / (kn(k + 1) - kn(k - 1));
                    h(s, k) - (h(s, k - 1) as f32 + t * (h(s, k + 1) - h(s, k - 1)) as f32).round() as i32
                } else {
                    h(s, k) - 32 * (kn(k) * p).round() as i32
                });
            }
            let e: Vec<f64> =
                v.iter().map(|x| if x.is_empty() { 1e9 } else { entropy(x.iter().copied()) }).collect();
            let best = (0..8).filter(|i| *i != 6).min_by(|a, b| e[*a].total_cmp(&e[*b])).unwrap();
            v[6] = v[best].clone();
            for i in 0..8 {
                own[i] += entropy(v[i].iter().copied());
                pooled[i].extend(&v[i]);
            }
        }
    }
    for i in 0..8 {
        println!(
            "{:40} own {:.0} pooled {:.0}",
            names[i],
            own[i] / n,
            entropy(pooled[i].iter().copied()) / n
        );
    }
    let snapped = drafts.iter().flat_map(|d| d.quantise().warp_y.hinted).filter(|h| h % 32 == 0).count();
    println!("on grid: {} of {}", snapped, drafts.iter().map(|d| d.hinted[1].len()).sum::<usize>());
}
