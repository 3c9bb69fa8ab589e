//! Runs egui without a window and paints what it gives on the CPU.

use std::collections::HashMap;

use egui::epaint::{ImageData, ImageDelta, Mesh, Primitive, Vertex};
use egui::{Color32, ColorImage, Context, Pos2, RawInput, Rect, TextureId, Ui, Vec2, pos2};

/// A context with its textures.
pub(crate) struct Screen {
    pub(crate) ctx: Context,
    textures: HashMap<TextureId, ColorImage>,
    size: Vec2,
    pixels_per_point: f32,
}

/// What a frame shows: the pixels, and the shapes that they come from.
pub(crate) struct Picture {
    pub(crate) image: ColorImage,
    pub(crate) shapes: Vec<egui::epaint::ClippedShape>,
    /// How many textures were sent.
    pub(crate) uploads: usize,
}

impl Screen {
    /// A screen of so many points, whose Proportional and Monospace fonts are this one.
    pub(crate) fn new(size: [f32; 2], pixels_per_point: f32, font: &[u8]) -> Self {
        let ctx = Context::default();
        let mut fonts = egui::FontDefinitions::empty();
        fonts.font_data.insert("font".to_owned(), egui::FontData::from_owned(font.to_vec()).into());
        for family in fonts.families.values_mut() {
            family.push("font".to_owned());
        }
        ctx.set_fonts(fonts);
        Self { ctx, textures: HashMap::new(), size: size.into(), pixels_per_point }
    }

    /// Runs a frame on black ground.
    pub(crate) fn run(&mut self, ui: impl FnMut(&mut Ui)) -> Picture {
        let mut input =
            RawInput { screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)), ..RawInput::default() };
        if let Some(viewport) = input.viewports.get_mut(&input.viewport_id) {
            viewport.native_pixels_per_point = Some(self.pixels_per_point);
        }
        let mut output = self.ctx.run_ui(input, ui);
        let mut uploads = 0;
        for (id, delta) in output
            .textures_delta
            .set
            .drain()
            .flat_map(|(id, deltas)| deltas.into_iter().map(move |delta| (id, delta)))
        {
            self.upload(id, &delta);
            uploads += 1;
        }
        output.textures_delta.clear();
        let side = |points: f32| (points * self.pixels_per_point).round() as usize;
        let size = [side(self.size.x), side(self.size.y)];
        let mut image = ColorImage::filled(size, Color32::BLACK);
        for clipped in self.ctx.tessellate(output.shapes.clone(), self.pixels_per_point) {
            if let Primitive::Mesh(mesh) = &clipped.primitive {
                self.paint(&mut image, clipped.clip_rect, mesh);
            }
        }
        Picture { image, shapes: std::mem::take(&mut output.shapes), uploads }
    }

    fn upload(&mut self, id: TextureId, delta: &ImageDelta) {
        let ImageData::Color(patch) = &delta.image;
        let Some([left, top]) = delta.pos else {
            self.textures.insert(id, patch.as_ref().clone());
            return;
        };
        if let Some(texture) = self.textures.get_mut(&id) {
            for y in 0..patch.height() {
                for x in 0..patch.width() {
                    texture[(left + x, top + y)] = patch[(x, y)];
                }
            }
        }
    }

    fn paint(&self, image: &mut ColorImage, clip: Rect, mesh: &Mesh) {
        let Some(texture) = self.textures.get(&mesh.texture_id) else { return };
        let scaled = |at: Pos2| (at.to_vec2() * self.pixels_per_point).to_pos2();
        let clip = Rect::from_min_max(scaled(clip.min).round(), scaled(clip.max).round());
        for corners in mesh.indices.chunks_exact(3) {
            let corner = |at: usize| {
                let vertex = mesh.vertices[corners[at] as usize];
                Vertex { pos: scaled(vertex.pos), ..vertex }
            };
            triangle(image, clip, [corner(0), corner(1), corner(2)], texture);
        }
    }
}

/// Fills a triangle at the centres of pixels; a centre on an edge belongs to the triangle on one side of it.
fn triangle(image: &mut ColorImage, clip: Rect, mut corners: [Vertex; 3], texture: &ColorImage) {
    let cross = |a: Pos2, b: Pos2, c: Pos2| (b - a).x * (c - a).y - (b - a).y * (c - a).x;
    if cross(corners[0].pos, corners[1].pos, corners[2].pos) < 0.0 {
        corners.swap(1, 2);
    }
    let [a, b, c] = corners;
    let area = cross(a.pos, b.pos, c.pos);
    let bounds = Rect::from_points(&[a.pos, b.pos, c.pos]);
    let whole = Rect::from_min_size(Pos2::ZERO, egui::vec2(image.width() as f32, image.height() as f32));
    let bounds = bounds.intersect(clip).intersect(whole);
    // Clockwise on a screen: edges that go up or, if level, right have the inside on the right or below.
    let owned = |from: Pos2, to: Pos2| to.y < from.y || (to.y == from.y && to.x > from.x);
    for y in bounds.top().floor() as usize..bounds.bottom().ceil().max(0.0) as usize {
        for x in bounds.left().floor() as usize..bounds.right().ceil().max(0.0) as usize {
            let at = pos2(x as f32 + 0.5, y as f32 + 0.5);
            let weights = [(b.pos, c.pos), (c.pos, a.pos), (a.pos, b.pos)].map(|(from, to)| {
                // Rounded alike for the triangles on both sides.
                let ascending = (from.x, from.y) < (to.x, to.y);
                let weight = if ascending { cross(from, to, at) } else { -cross(to, from, at) };
                if weight > 0.0 || (weight == 0.0 && owned(from, to)) { weight / area } else { -1.0 }
            });
            if area > 0.0 && clip.contains(at) && weights.iter().all(|weight| *weight >= 0.0) {
                let color = mixed(&corners, weights, texture);
                image[(x, y)] = over(color, image[(x, y)]);
            }
        }
    }
}

/// The colour of a triangle at a point, times the nearest texel, as egui's shaders have it in sRGB.
fn mixed(corners: &[Vertex; 3], weights: [f32; 3], texture: &ColorImage) -> Color32 {
    let sum = |value: fn(&Vertex) -> f32| -> f32 {
        corners.iter().zip(weights).map(|(vertex, weight)| value(vertex) * weight).sum()
    };
    let texel = |part: f32, side: usize| ((part * side as f32).max(0.0) as usize).min(side - 1);
    let (u, v) = (sum(|vertex| vertex.uv.x), sum(|vertex| vertex.uv.y));
    let texel = texture[(texel(u, texture.width()), texel(v, texture.height()))].to_array();
    let color: [fn(&Vertex) -> f32; 4] = [
        |vertex| vertex.color[0].into(),
        |vertex| vertex.color[1].into(),
        |vertex| vertex.color[2].into(),
        |vertex| vertex.color[3].into(),
    ];
    let [r, g, b, a] =
        std::array::from_fn(|at| (sum(color[at]) * f32::from(texel[at]) / 255.0).round() as u8);
    Color32::from_rgba_premultiplied(r, g, b, a)
}

/// One premultiplied colour over another.
pub(crate) fn over(top: Color32, ground: Color32) -> Color32 {
    let seen = 255.0 - f32::from(top.a());
    let [r, g, b, a] = std::array::from_fn(|at| {
        (f32::from(top[at]) + f32::from(ground[at]) * seen / 255.0).round().min(255.0) as u8
    });
    Color32::from_rgba_premultiplied(r, g, b, a)
}
