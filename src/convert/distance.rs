//! Exact signed distance to an outline, for the field's first guess.

/// Distance from `point` to the nearest of the straight `segments`, positive inside (nonzero winding).
/// Everything in em.
pub(super) fn signed_distance(segments: &[[[f32; 2]; 2]], point: [f32; 2]) -> f32 {
    let [x, y] = point;
    let mut nearest = f32::INFINITY;
    let mut winding = 0;
    for &[[ax, ay], [bx, by]] in segments {
        let (dx, dy) = (bx - ax, by - ay);
        let t = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        let (ex, ey) = (ax + t * dx - x, ay + t * dy - y);
        nearest = nearest.min(ex * ex + ey * ey);
        let side = dx * (y - ay) - dy * (x - ax);
        if ay <= y && by > y && side > 0.0 {
            winding += 1;
        } else if by <= y && ay > y && side < 0.0 {
            winding -= 1;
        }
    }
    if winding != 0 { nearest.sqrt() } else { -nearest.sqrt() }
}
