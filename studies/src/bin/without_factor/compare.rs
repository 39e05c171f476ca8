//! How two paths of the same surface differ.

use std::collections::HashMap;

use asperity::loading::LoadingState;

/// Events closer than this, relative to the approach that is computed with, are ties.
const TIE: f64 = 1e-9;
/// The same over the mean gap.
const ROUNDING: f64 = 1e-14;
/// Approaches closer than this, relative to the one that is computed with, are one.
const SAME: f64 = 1e-13;
/// Events on either side over which spacings are averaged.
const AROUND: usize = 32;

/// How far two states are from each other.
type Difference<'a> = &'a dyn Fn(&LoadingState, &LoadingState) -> f64;

/// Prints how a path differs from an exact one. The approach that is computed with contains the displacement `uniform`
/// for each unit of load.
pub(crate) fn print(found: &[LoadingState], exact: &[LoadingState], uniform: f64) {
    let place: HashMap<(usize, usize), usize> =
        exact.iter().enumerate().map(|(k, state)| (state.node, k)).collect();
    let count = found.len().min(exact.len());
    let approach = |k: usize| exact[k].contact.approach;
    let computed = |state: &LoadingState| state.contact.approach + uniform * state.contact.load;
    // Nodes that join at one approach are ties as far as they say themselves.
    let together = |k: usize| {
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
        let same = |other: &LoadingState| {
            (other.contact.approach - found[k].contact.approach).abs() <= SAME * computed(&found[k])
        };
        match beside.filter_map(|k| found.get(k)).any(same) {
            true => found[k].approach_error,
            false => 0.0,
        }
    };
    let tie = |k: usize| {
        // Heights are rounded.
        let rounding = ROUNDING * exact[0].contact.mean_gap;
        (TIE * computed(&exact[k])).max(rounding).max(together(k))
    };
    let (mut places, mut events) = (0, 0);
    let (mut errors, mut exceeded, mut worst) = (Vec::new(), 0, 0.0_f64);
    for (k, state) in found[..count].iter().enumerate() {
        let Some(&own) = place.get(&state.node) else {
            places += 1;
            events += 1;
            continue;
        };
        if own != k {
            places += 1;
            if (approach(own) - approach(k)).abs() > tie(k) {
                events += 1;
            }
        }
        let error = (state.contact.approach - approach(own)).abs();
        let (first, last) = (own.saturating_sub(AROUND), (own + AROUND).min(exact.len() - 1));
        let spacing = (approach(last) - approach(first)) / (last - first) as f64;
        if spacing > 0.0 {
            errors.push(error / spacing);
        }
        // Both solutions may be off by their tolerance.
        let bound = state.approach_error + 0.2 * tie(own);
        if error > bound {
            exceeded += 1;
        }
        if bound > 0.0 {
            worst = worst.max(error / bound);
        }
    }
    println!(
        "  places that differ: {places} ({:.3} %), without ties {events}; error over estimate: \
         {exceeded} above 1 ({:.3} %), worst {worst:.2}",
        100.0 * places as f64 / count as f64,
        100.0 * exceeded as f64 / count as f64
    );
    println!("  approach over spacing: {}", quantiles(errors));
    // Where no tie makes the order of equals matter.
    let clear = |k: &usize| {
        let next = exact.get(k + 1).map_or(f64::INFINITY, |next| next.contact.approach);
        approach(*k) > 0.0 && next - approach(*k) > tie(*k)
    };
    let alike: Vec<usize> = (0..count).filter(clear).filter(|&k| !is_full(&exact[k])).collect();
    let initial = exact[0].contact.mean_gap;
    let columns: [(&str, Difference<'_>); 5] = [
        ("load", &|a, b| relative(a.contact.load, b.contact.load)),
        ("stiffness", &|a, b| {
            relative(
                a.contact.contact_stiffness.unwrap_or(1.0),
                b.contact.contact_stiffness.unwrap_or(1.0),
            )
        }),
        ("interfacial stiffness", &|a, b| {
            relative(
                a.contact.interfacial_stiffness.unwrap_or(1.0),
                b.contact.interfacial_stiffness.unwrap_or(1.0),
            )
        }),
        ("mean gap over initial", &|a, b| {
            (a.contact.mean_gap - b.contact.mean_gap).abs() / initial
        }),
        ("energy", &|a, b| relative(a.contact.energy, b.contact.energy)),
    ];
    for (name, error) in columns {
        let errors = alike.iter().map(|&k| error(&found[k], &exact[k]));
        println!("  {name}: {}", quantiles(errors.collect()));
    }
}

fn is_full(state: &LoadingState) -> bool {
    state.contact.contact_area_fraction == 1.0
}

fn relative(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

fn quantiles(mut values: Vec<f64>) -> String {
    if values.is_empty() {
        return "nothing to compare".to_owned();
    }
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    format!(
        "median {:.1e}, 99 % {:.1e}, worst {:.1e}",
        values[last / 2],
        values[last * 99 / 100],
        values[last]
    )
}
