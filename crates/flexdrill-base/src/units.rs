//! The only place where units are converted: everything inside is SI.

use std::f64::consts::PI;

/// r/min to rad/s.
pub fn rpm_to_rad_per_s(rpm: f64) -> f64 {
    rpm * PI / 30.0
}

/// rad/s to r/min.
pub fn rad_per_s_to_rpm(rad_per_s: f64) -> f64 {
    rad_per_s * 30.0 / PI
}

/// kN to N.
pub fn kn_to_n(kn: f64) -> f64 {
    kn * 1e3
}

/// N to kN.
pub fn n_to_kn(n: f64) -> f64 {
    n / 1e3
}

/// m/h to m/s.
pub fn m_per_h_to_m_per_s(m_per_h: f64) -> f64 {
    m_per_h / 3600.0
}

/// m/s to m/h.
pub fn m_per_s_to_m_per_h(m_per_s: f64) -> f64 {
    m_per_s * 3600.0
}

/// MPa to Pa.
pub fn mpa_to_pa(mpa: f64) -> f64 {
    mpa * 1e6
}

/// Pa to MPa.
pub fn pa_to_mpa(pa: f64) -> f64 {
    pa / 1e6
}

/// Feet to metres, exact by definition.
pub fn ft_to_m(ft: f64) -> f64 {
    ft * 0.3048
}

/// Pounds-force per square inch to MPa: 1 in = 25.4 mm, exact by definition.
pub fn psi_to_mpa(psi: f64) -> f64 {
    lbf_to_kn(psi) * 1e3 / (25.4 * 25.4)
}

/// Degrees to radians.
pub fn deg_to_rad(deg: f64) -> f64 {
    deg * PI / 180.0
}

/// Radians to degrees.
pub fn rad_to_deg(rad: f64) -> f64 {
    rad * 180.0 / PI
}

/// Thousand pounds-force to kN: 1 lbf = 0.45359237 kg x 9.80665 m/s2, exact by definition.
pub fn klbf_to_kn(klbf: f64) -> f64 {
    klbf * 4.448_221_615_260_5
}

/// Pounds-force to kN, exact by definition.
pub fn lbf_to_kn(lbf: f64) -> f64 {
    klbf_to_kn(lbf / 1e3)
}

/// Kilograms-force to kN: 9.80665 m/s2, exact by definition.
pub fn kgf_to_kn(kgf: f64) -> f64 {
    kgf * 9.806_65 / 1e3
}

/// Tonnes-force to kN: a thousand kilograms-force.
pub fn tf_to_kn(tf: f64) -> f64 {
    tf * 9.806_65
}

/// Thousand foot-pounds-force to kN m: 1 ft = 0.3048 m, exact by definition.
pub fn kft_lbf_to_kn_m(kft_lbf: f64) -> f64 {
    klbf_to_kn(kft_lbf) * 0.3048
}

/// Multiples of the standard gravity to m/s2, exact by definition.
pub fn standard_gravities_to_m_per_s2(gravities: f64) -> f64 {
    gravities * 9.806_65
}

/// Sine and cosine of an angle (rad), alike on every machine.
pub fn sine_and_cosine(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        assert!((rpm_to_rad_per_s(30.0) - PI).abs() <= f64::EPSILON * PI);
        assert_eq!(kn_to_n(10.0), 1e4);
        assert_eq!(m_per_h_to_m_per_s(3.6), 1e-3);
        assert_eq!(mpa_to_pa(20.0), 2e7);
        assert!((deg_to_rad(180.0) - PI).abs() <= f64::EPSILON * PI);
        assert!((klbf_to_kn(100.0) - 444.822).abs() < 1e-3);
        assert!((lbf_to_kn(1000.0) - klbf_to_kn(1.0)).abs() < 1e-15);
        assert!((tf_to_kn(10.0) - kgf_to_kn(10_000.0)).abs() < 1e-13);
        assert_eq!(tf_to_kn(1.0), 9.806_65);
        // 1 psi = 6.894757 kPa (NIST SP 811, B.8), to its seven digits.
        assert!((psi_to_mpa(1e3) - 6.894_757).abs() < 5e-7);
        assert_eq!(ft_to_m(10.0), 3.048);
        // 1 ft.lbf = 1.355818 N m (NIST SP 811, B.8), to its seven digits.
        assert!((kft_lbf_to_kn_m(1.0) - 1.355_818).abs() < 5e-7);
    }

    #[test]
    fn conversions_invert() {
        assert!((rad_per_s_to_rpm(rpm_to_rad_per_s(40.0)) - 40.0).abs() < 1e-12);
        assert!((rad_to_deg(deg_to_rad(2.7)) - 2.7).abs() < 1e-12);
        assert_eq!(n_to_kn(kn_to_n(10.0)), 10.0);
        assert!((m_per_s_to_m_per_h(m_per_h_to_m_per_s(3.0)) - 3.0).abs() < 1e-15);
        assert_eq!(pa_to_mpa(mpa_to_pa(20.0)), 20.0);
    }
}
