//! What this crate exports goes from thread to thread, and is shared by them: this compiles.

use asperity_surfaces::surface::{
    Amplitude, Axis, BiWave, Cone, Cylinder, EllipticParaboloid, Estimate, Filter, FittedTrend,
    FlatPunch, Interpolation, Paraboloid, RadialBins, SelfAffineFit, SpectralBin, SpectralMoments,
    Spectrum, Sum, Topography, Trend, Wave, Window,
};
use asperity_surfaces::{Error, FileError, Grid, HeightMap, SelfAffine, Warning};

const fn shared<T: Send + Sync + std::fmt::Debug>() {}

const _: () = {
    shared::<(Error, FileError, Grid, Warning, HeightMap, Topography)>();
    shared::<(SelfAffine, Amplitude, Spectrum, Axis, Wave, BiWave)>();
    shared::<(Paraboloid, EllipticParaboloid, Cylinder, Cone, FlatPunch)>();
    shared::<Sum<Wave, FlatPunch>>();
    shared::<(Trend, FittedTrend, Filter, Interpolation, Window)>();
    shared::<(RadialBins, SpectralBin, SpectralMoments)>();
    shared::<(SelfAffineFit, Estimate)>();
};

#[cfg(feature = "io")]
const _: () = {
    use asperity_surfaces::io::{Format, LengthUnit, MeasuredSurface, ReadOptions};
    shared::<(Format, LengthUnit, MeasuredSurface, ReadOptions)>();
};
