//! Spheres against the closed forms of Maugis (1992) and of Johnson, Kendall and Roberts (1971).
//!
//! Loads are in units of π w R, approaches in those of (π² w² R / K²)^⅓ and radii in those of (π w R² / K)^⅓, with
//! K = 4 E* / 3.

use std::f64::consts::PI;

use asperity::adhesion::{Adhesion, AdhesiveBranch, AdhesivePath};
use asperity::surface::Paraboloid;
use asperity::{Boussinesq, ContactTarget, Grid};

/// E* = R = 1 and a contact radius of 1 in the limit of JKR at pull-off: w = 8 E* a³ / (9 π R²).
const WORK: f64 = 8.0 / (9.0 * PI);
/// The approach to which the sphere is pressed, at which JKR pull with 0.4 still.
const END: f64 = 0.8;

/// One state.
#[derive(Debug, Clone, Copy)]
struct State {
    load: f64,
    approach: f64,
    radius: f64,
}

/// A closed form, from apart to far beyond [`END`].
struct Curve(Vec<State>);

const POINTS: usize = 40_000;
/// Apart nothing pulls.
const APART: f64 = -20.0;
const NOTHING: State = State { load: 0.0, approach: APART, radius: 0.0 };

impl Curve {
    /// P = a³ − √(6 a³), δ = a² − √(8 a / 3).
    fn jkr() -> Self {
        let contact = (0..POINTS).map(|k| {
            let a = 2.5 * k as f64 / POINTS as f64;
            let (load, approach) =
                (a.powi(3) - (6.0 * a.powi(3)).sqrt(), a * a - (a / 0.375).sqrt());
            State { load, approach, radius: a }
        });
        Self([NOTHING].into_iter().chain(contact).collect())
    }

    /// Maugis' equations, with λ = 1.157 μ, and before contact a uniform stress on a circle of a radius c:
    ///
    /// ```text
    /// P = −λ c² π / 2,   δ = c² / 2 − (4/π) (π λ / 2) (2/3) c − h₀
    /// ```
    ///
    /// in units of which σ₀ = λ/2 (π w K² / R)^⅓ and h₀ = w / σ₀.
    fn maugis(tabor: f64) -> Self {
        let lambda = 1.157 * tabor;
        // σ₀ over E*, and lengths, with K = 4/3 and R = 1.
        let unit = (PI * WORK / (4.0 / 3.0)).cbrt();
        let stress = 0.5 * lambda * (PI * WORK * 16.0 / 9.0).cbrt();
        let range = WORK / stress;
        let mut states = vec![NOTHING];
        // Apart: the circle grows until its middle touches.
        for k in 0..POINTS {
            let c = 3.0 * k as f64 / POINTS as f64;
            let approach = 0.5 * c * c - 4.0 * stress * c / PI - range;
            if -approach - 2.0 * stress * c < 0.0 {
                break;
            }
            let load = -stress * c * c / WORK;
            states.push(State { load, approach: approach / (unit * unit), radius: 0.0 });
        }
        // In contact: from a wide ring of cohesion around a point to hardly any around a wide circle.
        for k in 1..POINTS {
            let angle = 0.5 * PI * (1.0 - k as f64 / POINTS as f64);
            let m = 1.0 / angle.cos();
            let root = angle.tan();
            let square = 0.5 * lambda * (root + (m * m - 2.0) * angle);
            let linear = 4.0 / 3.0 * lambda * lambda * (root * angle - m + 1.0);
            let a = 2.0 / (linear + (linear * linear + 4.0 * square).sqrt());
            if a > 2.5 {
                break;
            }
            let load = a.powi(3) - lambda * a * a * (root + m * m * angle);
            let approach = a * a - 4.0 / 3.0 * lambda * a * root;
            states.push(State { load, approach, radius: a });
        }
        Self(states)
    }

    fn pull_off(&self) -> f64 {
        -self.0.iter().map(|state| state.load).fold(0.0, f64::min)
    }

    /// The state at a load between pull-off and the end.
    fn at_load(&self, load: f64) -> State {
        let above = self.0.iter().rposition(|state| state.load < load).unwrap();
        let [a, b] = [self.0[above], self.0[above + 1]];
        let part = (load - a.load) / (b.load - a.load);
        let between = |x: f64, y: f64| x + part * (y - x);
        State {
            load,
            approach: between(a.approach, b.approach),
            radius: between(a.radius, b.radius),
        }
    }

    /// What a loop costs at held approaches, in units of the load times the approach. Loading has the states farther
    /// than all before them on the curve, and unloading those nearer than all behind.
    fn lost(&self) -> f64 {
        let mut loading: Vec<State> = Vec::new();
        for state in &self.0 {
            if loading.last().is_none_or(|last| state.approach > last.approach) {
                loading.push(*state);
            }
        }
        let mut unloading: Vec<State> = Vec::new();
        for state in self.0.iter().rev() {
            if unloading.last().is_none_or(|last| state.approach < last.approach) {
                unloading.push(*state);
            }
        }
        unloading.reverse();
        let load = |states: &[State], approach: f64| {
            let behind = states.partition_point(|state| state.approach < approach);
            let [a, b] = [states[behind - 1], states[behind]];
            // Beyond the range nothing pulls, and a jump is there at once.
            if a.approach == APART {
                return 0.0;
            }
            a.load + (approach - a.approach) / (b.approach - a.approach) * (b.load - a.load)
        };
        let step = (END - APART) / POINTS as f64;
        let middles = (0..POINTS).map(|k| APART + (k as f64 + 0.5) * step);
        middles.map(|at| step * (load(&loading, at) - load(&unloading, at))).sum()
    }
}

/// A loop up to [`END`]: the branch of unloading.
struct Loop(AdhesiveBranch);

/// With so many cells in the contact radius that JKR has at pull-off, on a grid of so many of these radii on each side.
fn measured(cells: usize, half: f64, law: impl Fn(f64) -> Adhesion) -> Loop {
    let nodes = (2.0 * half * cells as f64).round() as usize;
    let grid = Grid::square(nodes, nodes as f64 / cells as f64).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let sphere = Paraboloid::new(1.0).unwrap();
    let builder = AdhesivePath::builder(&sphere, &kernel, law(WORK));
    let end = END * Loop::length();
    let mut path = builder.until(ContactTarget::Approach(end)).build().unwrap();
    path.by_ref().try_for_each(|state| state.map(|_| ())).unwrap();
    path.unload().unwrap();
    Loop(path.run().unwrap())
}

impl Loop {
    /// The unit of the approach.
    fn length() -> f64 {
        (PI * PI * WORK * WORK * 9.0 / 16.0).cbrt()
    }

    fn pull_off(&self) -> f64 {
        self.0.pull_off() / (PI * WORK)
    }

    /// Of the whole path, which began apart.
    fn lost(&self) -> f64 {
        self.0.states().last().unwrap().dissipated / (PI * WORK * Self::length())
    }

    /// Approach at a load, and the radius of a circle of the area in contact.
    fn at_load(&self, load: f64) -> (f64, f64) {
        let force = load * PI * WORK;
        let approach = self.0.approach_at(force).unwrap() / Self::length();
        let state = self.0.states().iter().find(|state| state.contact.load <= force).unwrap();
        (approach, (state.contact.contact_area / PI).sqrt() / (PI * WORK * 0.75).cbrt())
    }
}

fn maugis(tabor: f64) -> impl Fn(f64) -> Adhesion {
    move |work| Adhesion::maugis(work, 1.157 * tabor * (2.0 * PI * work / 9.0).cbrt())
}

/// How far radii and approaches are from the closed form at some loads up to nine tenths of pull-off, in units of a
/// cell.
fn errors(found: &Loop, curve: &Curve, cells: usize) -> [f64; 2] {
    let cell = 1.0 / (cells as f64 * (PI * WORK * 0.75).cbrt());
    let mut worst = [0.0_f64; 2];
    for part in [0.4, 0.5, 0.6, 0.7, 0.8, 0.9] {
        let exact = curve.at_load(-part * curve.pull_off());
        let (approach, radius) = found.at_load(exact.load);
        for (worst, error) in
            worst.iter_mut().zip([radius - exact.radius, approach - exact.approach])
        {
            *worst = worst.max(error.abs() / cell);
        }
    }
    worst
}

/// A front moves by whole cells, and the contact under it to either side of its place: of radii that is a part of a
/// cell, and of the approach dδ/da of it, 2.5 at most here. So both errors fall with the cell.
fn check_errors(found: &Loop, curve: &Curve, cells: usize, context: &str) {
    let [radius, approach] = errors(found, curve, cells);
    println!("{context}, {cells} cells: {radius} of a cell, {approach}");
    assert!(radius < 0.75 && approach < 0.6, "{context}, {cells}: {radius} {approach}");
}

/// The curves themselves: pull-off of JKR, 3/2, and what a loop costs, from ∫ P dδ in closed form: 1.27493. A short
/// range comes to both.
#[test]
fn closed_forms_come_to_that_of_jkr() {
    let jkr = Curve::jkr();
    // Points are 6 × 10⁻⁵ apart, and approaches of the integral 5 × 10⁻⁴.
    assert!((jkr.pull_off() - 1.5).abs() < 1e-6 && (jkr.lost() - 1.27493).abs() < 1e-3);
    for (tabor, pull_off, bound) in
        [(0.3, 1.789, 1.0), (1.0, 1.582, 0.6), (3.0, 1.512, 0.2), (30.0, 1.5, 0.02)]
    {
        let curve = Curve::maugis(tabor);
        println!("{tabor}: {} {}", curve.pull_off(), curve.lost());
        assert!((curve.pull_off() / pull_off - 1.0).abs() < 1e-3, "{tabor}: {}", curve.pull_off());
        let less = 1.0 - curve.lost() / jkr.lost();
        assert!((0.0..=bound).contains(&less), "{tabor}: {less}");
    }
}

/// What a law says of spheres and cells: the radius at pull-off in the limit of JKR, which is that of the least load of
/// its curve, and how much longer cells may be.
#[test]
fn laws_know_their_spheres_and_cells() {
    let half_space =
        |cell: f64| Boussinesq::new(Grid::square(8, 8.0 * cell).unwrap(), 1.0).unwrap();
    let given = Adhesion::work(WORK).range(0.5);
    let law = given.on(&half_space(0.1)).unwrap();
    assert!((law.pull_off_radius(1.0, 1.0) - 1.0).abs() < 1e-14);
    // (9π w R² / 8E*)^⅓: twice the radius for eight times R², half of it for eight times E*.
    assert!((law.pull_off_radius(8.0_f64.sqrt(), 1.0) - 2.0).abs() < 1e-14);
    assert!((law.pull_off_radius(1.0, 8.0) - 0.5).abs() < 1e-14);
    let least = Curve::jkr().0.into_iter().min_by(|a, b| a.load.total_cmp(&b.load)).unwrap();
    // Points are 6 × 10⁻⁵ apart.
    assert!((least.radius * (PI * WORK * 0.75).cbrt() - 1.0).abs() < 1e-4, "{least:?}");
    let longer = given.on(&half_space(0.1 * law.cell_margin())).unwrap();
    assert!(
        (longer.resolution() - 0.5).abs() < 1e-13 && (longer.cell_margin() - 1.0).abs() < 1e-13
    );
}

/// The limit of JKR: what is left is the mesh, and the finite range that it asks for.
#[test]
fn loops_of_the_shortest_range_come_to_those_of_jkr() {
    let jkr = Curve::jkr();
    let [coarse, fine] = [(5, 0.07), (10, 0.04)].map(|(cells, bound)| {
        let found = measured(cells, 2.1, Adhesion::work);
        let error = found.pull_off() / 1.5 - 1.0;
        assert!(error.abs() < bound, "{cells}: {error}");
        check_errors(&found, &jkr, cells, "JKR");
        (error, found.lost())
    });
    assert!(fine.0 < coarse.0, "{coarse:?} {fine:?}");
    // Across the range contact jumps before surfaces touch, and the range falls as the root of the cell. So does what
    // is lacking of the loss, but for parts in proportion to the cell, a tenth of the radius.
    let lost = fine.1 + (fine.1 - coarse.1) / (2.0_f64.sqrt() - 1.0);
    assert!((lost / jkr.lost() - 1.0).abs() < 0.06, "{lost} {}", jkr.lost());
}

/// Maugis' law at three numbers of Tabor, the last one near JKR.
#[test]
fn loops_are_those_of_maugis() {
    let mut losses = Vec::new();
    for (tabor, cells, half, bound) in
        [(0.3, 5, 2.3, 0.025), (1.0, 5, 2.3, 0.045), (1.0, 10, 2.3, 0.02), (3.0, 20, 2.1, 0.02)]
    {
        let (curve, found) = (Curve::maugis(tabor), measured(cells, half, maugis(tabor)));
        let error = found.pull_off() / curve.pull_off() - 1.0;
        assert!(error.abs() < bound, "{tabor}: {error}");
        check_errors(&found, &curve, cells, &format!("Maugis {tabor}"));
        // The slope at the border of the law, which the cells ask for, takes from the loss: with the smallest number,
        // where jumps are smallest, half of it.
        let part = found.lost() / curve.lost();
        println!("{tabor}, {cells} cells: {part} of the loss");
        assert!((0.45..1.0).contains(&part), "{tabor}: {part}");
        losses.push(part);
    }
    // The slope is in proportion to the cells, and so is what it takes: what is left are 3 % of the quarter.
    let limit = 2.0 * losses[2] - losses[1];
    assert!((limit - 1.0).abs() < 0.03, "{losses:?}");
}
