//! Lenses of up to 220 degrees.

/// How the radius in the image goes with the angle from the axis.
#[derive(Clone, Copy, Debug)]
pub enum Lens {
    /// `theta`.
    Equidistant,
    /// `2 sin(theta / 2)`.
    Equisolid,
    /// `2 tan(theta / 2)`.
    Stereographic,
    /// `theta (1 + k theta^2)`, as a polynomial fisheye has it.
    Polynomial(f64),
    /// `(1 + xi) sin(theta) / (cos(theta) + xi)`: a sphere, then a pinhole (Mei & Rives 2007).
    Mei(f64),
}

impl Lens {
    /// The radius of an angle from the axis, focal lengths.
    fn radius(self, theta: f64) -> f64 {
        match self {
            Self::Equidistant => theta,
            Self::Equisolid => 2.0 * (0.5 * theta).sin(),
            Self::Stereographic => 2.0 * (0.5 * theta).tan(),
            Self::Polynomial(k) => theta * (1.0 + k * theta * theta),
            Self::Mei(xi) => (1.0 + xi) * theta.sin() / (theta.cos() + xi),
        }
    }

    /// Whether the radius rises up to an angle.
    pub fn reaches(self, theta: f64) -> bool {
        let steps = (0..=40).map(|step| self.radius(theta * f64::from(step) / 40.0));
        steps.collect::<Vec<f64>>().windows(2).all(|pair| pair[1] > pair[0] && pair[1].is_finite())
    }
}

/// A camera: a lens whose field ends on a circle.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub lens: Lens,
    pub width: usize,
    pub height: usize,
    /// Half the field, radians, and the radius of its circle, px.
    pub half_field: f64,
    pub radius: f64,
}

impl Camera {
    pub fn middle(&self) -> [f64; 2] {
        [0.5 * self.width as f64 - 0.3, 0.5 * self.height as f64 + 0.2]
    }

    /// Where a point before the camera (x right, y down, z ahead) is seen, px; `None` outside the field.
    pub fn at(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        let across = x.hypot(y);
        let theta = across.atan2(z);
        if theta > self.half_field {
            return None;
        }
        let radius = self.radius * self.lens.radius(theta) / self.lens.radius(self.half_field);
        let [cx, cy] = self.middle();
        let share = if across > 0.0 { radius / across } else { 0.0 };
        Some([cx + share * x, cy + share * y])
    }
}
