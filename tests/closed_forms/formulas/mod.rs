//! The closed forms themselves, against quadrature of their definitions and against each other.

mod area_load;
mod conductance;
mod cone;
mod double_wave;
mod hertz_ellipse;
mod hertz_line;
mod hertz_sphere;
mod punch;
mod quadrature;
mod westergaard;
