//! A volume of stresses as a file that ParaView reads.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use nalgebra::DMatrix;

use super::body::Subsurface;
use super::tensor::{Measure, StressField};
use crate::io::write_whole;
use crate::{Error, Grid};

/// Measures that are written, beside the tensor.
const MEASURES: [Measure; 3] =
    [Measure::VonMises, Measure::GreatestShear, Measure::GreatestTension];
/// Components of a symmetric tensor in the order of VTK: xx, yy, zz, xy, yz, xz, by their places in that of Voigt.
const TENSOR: [usize; 6] = [0, 1, 2, 5, 3, 4];
/// Most bytes of a file: places in it are signed.
const MOST_BYTES: u64 = i64::MAX as u64 / 2;

impl Subsurface {
    /// Writes the stresses at `count` depths, 0, `step`, 2 `step` and so on \[m\], as image data of VTK (`.vti`, single
    /// precision): the points are the centres of the cells, z is the depth, and each has `von_mises`, `greatest_shear`,
    /// `greatest_tension` and the tensor `stress` (xx, yy, zz, xy, yz, xz) \[Pa\].
    ///
    /// Memory is that of one depth; `visit` sees each field as it is found, from the surface down.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the step and the count, [`Error::OutOfRange`] for more depths than any file holds,
    /// those of [`at_depth`](Self::at_depth), and [`FileError::Io`](crate::FileError::Io).
    pub fn write_volume(
        &self,
        pressure: &DMatrix<f64>,
        (step, count): (f64, usize),
        file: impl AsRef<Path>,
        mut visit: impl FnMut(&StressField),
    ) -> Result<(), Error> {
        let step = Error::require_positive("distance of depths", step)?;
        Error::require_positive("number of depths", count as f64)?;
        let a_depth = bytes(self.grid().nodes(), MEASURES.len() + TENSOR.len());
        let fits = count as u64 <= MOST_BYTES / a_depth;
        Error::require("number of depths", count as f64, fits, "no more than any file holds")?;
        let mut refused = None;
        let written = write_whole(file, |output| {
            let volume = Volume::begin(output, &self.grid(), (step, count))?;
            for k in 0..count {
                match self.at_depth(pressure, k as f64 * step) {
                    Ok(field) => {
                        volume.put(output, k, &field)?;
                        visit(&field);
                    }
                    Err(error) => {
                        refused = Some(error);
                        return Err(std::io::ErrorKind::Other.into());
                    }
                }
            }
            output.seek(SeekFrom::End(0))?;
            output.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
        });
        match refused {
            Some(error) => Err(error),
            None => Ok(written?),
        }
    }
}

/// Where the arrays of a file begin. Each is preceded by its length in bytes.
struct Volume {
    nodes: usize,
    /// First byte and number of components of each array.
    arrays: Vec<(u64, usize)>,
}

impl Volume {
    fn begin(
        output: &mut BufWriter<File>,
        grid: &Grid,
        (step, count): (f64, usize),
    ) -> std::io::Result<Self> {
        let (nx, ny) = grid.shape();
        let extent = format!("0 {} 0 {} 0 {}", nx - 1, ny - 1, count - 1);
        let nodes = grid.nodes();
        let names = MEASURES.map(|measure| (measure.name(), 1)).into_iter();
        let names: Vec<(&str, usize)> = names.chain([("stress", TENSOR.len())]).collect();
        let bytes = |components: usize| count as u64 * bytes(nodes, components);
        let mut offset = 0;
        let mut arrays = Vec::new();
        let mut described = String::new();
        for (name, components) in &names {
            // Writing to a text cannot fail.
            let _ = writeln!(
                described,
                "        <DataArray type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
                 offset=\"{offset}\"/>"
            );
            arrays.push((offset, *components));
            offset += size_of::<u64>() as u64 + bytes(*components);
        }
        let (dx, dy) = (grid.dx(), grid.dy());
        let header = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             \x20 <ImageData WholeExtent=\"{extent}\" Origin=\"{:e} {:e} 0\" Spacing=\"{dx:e} {dy:e} {step:e}\">\n\
             \x20   <Piece Extent=\"{extent}\">\n\
             \x20     <PointData Scalars=\"von_mises\" Tensors=\"stress\">\n\
             {described}\
             \x20     </PointData>\n\
             \x20   </Piece>\n\
             \x20 </ImageData>\n\
             \x20 <AppendedData encoding=\"raw\">\n_",
            0.5 * dx,
            0.5 * dy
        );
        output.write_all(header.as_bytes())?;
        let first = header.len() as u64;
        for (place, components) in &mut arrays {
            *place += first;
            output.seek(SeekFrom::Start(*place))?;
            output.write_all(&bytes(*components).to_le_bytes())?;
            *place += size_of::<u64>() as u64;
        }
        Ok(Self { nodes, arrays })
    }

    /// The field at the k-th depth.
    fn put(
        &self,
        output: &mut BufWriter<File>,
        k: usize,
        field: &StressField,
    ) -> std::io::Result<()> {
        let maps = MEASURES.map(|measure| field.map(measure));
        let components = field.components();
        for (place, &(first, width)) in self.arrays.iter().enumerate() {
            let before = k as u64 * bytes(self.nodes, width);
            output.seek(SeekFrom::Start(first + before))?;
            for node in 0..self.nodes {
                match maps.get(place) {
                    Some(map) => put(output, map.as_slice()[node])?,
                    None => {
                        for component in TENSOR {
                            put(output, components[component].as_slice()[node])?;
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// Bytes of so many components at one depth.
fn bytes(nodes: usize, components: usize) -> u64 {
    (nodes * components * size_of::<f32>()) as u64
}

fn put(output: &mut BufWriter<File>, value: f64) -> std::io::Result<()> {
    output.write_all(&(value as f32).to_le_bytes())
}
