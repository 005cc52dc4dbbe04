//! What a lens does to a target beyond an affine map.

/// The second-order part of the map from a plane of the object to the image, at a point: what lies `d` px from it by the affine part lies `1/2 (xx dx^2 + 2 xy dx dy + yy dy^2)` farther, px.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Warp {
    /// Second derivative by x, 1/px.
    pub xx: [f64; 2],
    /// Mixed second derivative, 1/px.
    pub xy: [f64; 2],
    /// Second derivative by y, 1/px.
    pub yy: [f64; 2],
}

impl Warp {
    /// From the derivatives of the image point (px) by two coordinates u and v of the plane: the first, `[by u, by v]`, and the second, `[by u u, by u v, by v v]`. `None` where the first are parallel.
    pub fn of_derivatives([u, v]: [[f64; 2]; 2], [uu, uv, vv]: [[f64; 2]; 3]) -> Option<Self> {
        let determinant = u[0] * v[1] - v[0] * u[1];
        // Of x and y, how far they go along u and v.
        let [x, y] = [[v[1], -u[1]], [-v[0], u[0]]].map(|pair| pair.map(|part| part / determinant));
        let by = |a: [f64; 2], b: [f64; 2]| {
            [0, 1].map(|axis| a[0] * b[0] * uu[axis] + (a[0] * b[1] + a[1] * b[0]) * uv[axis] + a[1] * b[1] * vv[axis])
        };
        let warp = Self { xx: by(x, x), xy: by(x, y), yy: by(y, y) };
        let parts = warp.xx.into_iter().chain(warp.xy).chain(warp.yy);
        parts.into_iter().all(f64::is_finite).then_some(warp)
    }

    /// How far what lies `d` px away by the affine part is moved, px.
    #[inline]
    pub fn shift(&self, [dx, dy]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| 0.5 * (self.xx[axis] * dx * dx + 2.0 * self.xy[axis] * dx * dy + self.yy[axis] * dy * dy))
    }

    /// How a shift changes with the place: `change` px farther.
    #[inline]
    pub fn shift_along(&self, [dx, dy]: [f64; 2], change: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (self.xx[axis] * dx + self.xy[axis] * dy) * change[0] + (self.xy[axis] * dx + self.yy[axis] * dy) * change[1])
    }

    /// How far anything within `radius` px is moved at most, px: an upper bound, at most twice as far.
    pub fn farthest(&self, radius: f64) -> f64 {
        let [xx, xy, yy] = [self.xx, self.xy, self.yy].map(|[x, y]| x.hypot(y));
        0.5 * (xx.max(yy) + xy) * radius * radius
    }

    /// The curvature of a straight line of the object with this unit normal in the image, 1/px: positive where its middle lies towards the normal.
    pub fn curvature(&self, [x, y]: [f64; 2]) -> f64 {
        let [along_x, along_y] = self.shift([-y, x]);
        -2.0 * (along_x * x + along_y * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point of the object in the image of a lens, in the plane's own oblique coordinates.
    fn image([u, v]: [f64; 2]) -> [f64; 2] {
        let [x, y] = [30.0 * u + 8.0 * v + 2.0 * u * v, -6.0 * u + 25.0 * v];
        let bent = 1.0 - 2e-4 * (x * x + y * y);
        [x * bent, y * bent]
    }

    fn derivatives(at: [f64; 2]) -> ([[f64; 2]; 2], [[f64; 2]; 3]) {
        let h = 1e-4;
        let by = |weights: &[(f64, f64, f64)], scale: f64| {
            weights.iter().fold([0.0; 2], |sum, (u, v, weight)| {
                let at = image([at[0] + u * h, at[1] + v * h]);
                [0, 1].map(|axis| sum[axis] + weight * at[axis] / scale)
            })
        };
        let first = [by(&[(1.0, 0.0, 0.5), (-1.0, 0.0, -0.5)], h), by(&[(0.0, 1.0, 0.5), (0.0, -1.0, -0.5)], h)];
        let twice = |u: f64, v: f64| by(&[(u, v, 1.0), (0.0, 0.0, -2.0), (-u, -v, 1.0)], h * h);
        let mixed = by(&[(1.0, 1.0, 0.25), (1.0, -1.0, -0.25), (-1.0, 1.0, -0.25), (-1.0, -1.0, 0.25)], h * h);
        (first, [twice(1.0, 0.0), mixed, twice(0.0, 1.0)])
    }

    #[test]
    fn points_nearby_lie_where_affine_part_and_warp_say() {
        let at = [0.4, -0.3];
        let (first, second) = derivatives(at);
        let warp = Warp::of_derivatives(first, second).unwrap();
        for (du, dv) in [(0.01, 0.0), (0.0, -0.01), (0.008, 0.006), (-0.004, 0.009)] {
            let affine = [0, 1].map(|axis| du * first[0][axis] + dv * first[1][axis]);
            let (shift, here, there) = (warp.shift(affine), image(at), image([at[0] + du, at[1] + dv]));
            for axis in 0..2 {
                let off = there[axis] - here[axis] - affine[axis] - shift[axis];
                assert!(off.abs() < 2e-5 && shift[axis].abs() > 0.0, "{off:e} {shift:?}");
            }
        }
        assert_eq!(Warp::of_derivatives([first[0], first[0]], second), None);
    }

    #[test]
    fn a_line_is_curved_as_its_points_lie() {
        let at = [0.4, -0.3];
        let (first, second) = derivatives(at);
        let warp = Warp::of_derivatives(first, second).unwrap();
        // The line along u: three of its points on a circle, whose middle is on the hollow side.
        let tangent = first[0].map(|part| part / first[0][0].hypot(first[0][1]));
        for normal in [[-tangent[1], tangent[0]], [tangent[1], -tangent[0]]] {
            let [behind, here, ahead] = [-0.01, 0.0, 0.01].map(|step| image([at[0] + step, at[1]]));
            let chord = [ahead[0] - behind[0], ahead[1] - behind[1]];
            let middle = [0, 1].map(|axis| 0.5 * (ahead[axis] + behind[axis]) - here[axis]);
            let sagitta = -(middle[0] * normal[0] + middle[1] * normal[1]);
            let curvature = 8.0 * sagitta / (chord[0] * chord[0] + chord[1] * chord[1]);
            let found = warp.curvature(normal);
            assert!((found / curvature - 1.0).abs() < 1e-3, "{found} {curvature}");
        }
    }
}
