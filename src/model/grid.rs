//! The grids of a glyph's field and of its deformation.

/// How far the field's grid reaches beyond the outline's box (em).
pub const PADDING: f32 = 0.03;
/// Nodes of the deformation's grid along each axis.
pub const DEFORM_NODES: usize = 8;

/// The field's grid along one axis, in em.
#[derive(Debug, Clone, Copy)]
pub struct GridAxis {
    /// Where the first cell begins.
    pub origin: f32,
    /// Cells per em.
    pub cells_per_em: f32,
    /// The number of cells.
    pub cells: usize,
}

impl GridAxis {
    /// The grid over `low..high` (em) and `PADDING` around it.
    pub fn new(low: f32, high: f32, cells: usize) -> Self {
        let span = (high - low) + 2.0 * PADDING;
        Self { origin: low - PADDING, cells_per_em: cells as f32 / span, cells }
    }

    /// The position of a deformation node (em).
    pub fn node(&self, node: usize) -> f32 {
        self.origin + node as f32 / (DEFORM_NODES - 1) as f32 * self.cells as f32 / self.cells_per_em
    }

    /// The deformation node at or below `q` (em), and how far `q` lies towards the next one, 0..1.
    #[inline]
    pub fn locate_node(&self, q: f32) -> (usize, f32) {
        let share = (q - self.origin) * self.cells_per_em / self.cells as f32;
        let u = (share * (DEFORM_NODES - 1) as f32).clamp(0.0, (DEFORM_NODES - 1) as f32);
        let node = (u as usize).min(DEFORM_NODES - 2);
        (node, u - node as f32)
    }
}

/// Quadratic B-spline weights of the three coefficients around position `t` (0..1) of a cell.
#[inline]
pub fn spline(t: f32) -> [f32; 3] {
    let s = 1.0 - t;
    [0.5 * s * s, 0.5 + t * s, 0.5 * t * t]
}
