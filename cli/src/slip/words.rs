//! What is printed.

use asperity::kernel::KernelOrigin;
use asperity::slip::SlipState;
use asperity_cli::number::{area, counted, quantity};
use asperity_cli::say;
use serde_json::{Value, json};

use super::history::Sheared;
use super::joint::Joint;

/// One object for programs.
pub(super) fn object(joint: &Joint, sheared: Option<&Sheared>) -> Value {
    let (state, cycle) = (&joint.state, &joint.cycle);
    let friction = joint.slip.friction();
    json!({
        "load": state.load,
        "tangential_load": state.tangential_load,
        "displacement": state.displacement,
        "interfacial_displacement": state.interfacial_displacement,
        "stick_area": state.stick_area,
        "slip_area": state.slip_area,
        "stick_nodes": state.stick_nodes,
        "slipping_nodes": state.slipping_nodes,
        "tangential_stiffness": state.tangential_stiffness,
        "dissipation": cycle.dissipation,
        "secant_stiffness": cycle.secant_stiffness,
        "loss_factor": cycle.loss_factor,
        "sliding_load": joint.slip.sliding_load(),
        "sliding_displacement": joint.slip.sliding_displacement(),
        "friction": friction.coefficient(),
        "compliance_ratio": friction.compliance_ratio(),
        "dundurs_beta": friction.dundurs_beta(),
        "history_dissipation": sheared.map(Sheared::dissipation),
        "warnings": joint.warnings,
    })
}

/// Lines for people.
pub(super) fn print(joint: &Joint, sheared: Option<&Sheared>) {
    let (state, cycle) = (&joint.state, &joint.cycle);
    let friction = joint.slip.friction();
    let (nx, ny) = joint.record.grid().shape();
    let periodic = if joint.is_periodic() {
        ", periodic half-space: displacements are those of the mean planes"
    } else {
        ""
    };
    say!(
        "path          {} on {nx} x {ny} nodes{periodic}",
        counted(joint.record.states().len(), "state")
    );
    say!("bodies        {}", joint.bodies);
    let beta = match friction.dundurs_beta() {
        Some(beta) => format!(", Dundurs' β {beta:.3}"),
        None => ", Dundurs' β unknown".to_string(),
    };
    say!(
        "friction      {}, ratio of compliances κ {:.4}{beta}",
        friction.coefficient(),
        friction.compliance_ratio()
    );
    say!(
        "preload       {}: slides at T = {} and U = {}",
        quantity(state.load, "N", 4),
        quantity(joint.slip.sliding_load(), "N", 4),
        quantity(joint.slip.sliding_displacement(), "m", 4)
    );
    say!();
    let share = state.tangential_load / joint.slip.sliding_load();
    say!(
        "under T = {} ({:.1} % of the sliding load), grown from zero:",
        quantity(state.tangential_load, "N", 4),
        100.0 * share
    );
    say!(
        "  displacement         {}, of which the joint itself {}",
        quantity(state.displacement, "m", 4),
        quantity(state.interfacial_displacement, "m", 4)
    );
    let stiffness = |state: &SlipState| quantity(state.tangential_stiffness, "N/m", 4);
    let sticking = joint.loading.first().map(stiffness);
    say!(
        "  tangent stiffness    {}; before any slip {}",
        stiffness(state),
        sticking.unwrap_or_default()
    );
    say!(
        "  sticks               {}, {}",
        counted(state.stick_nodes, "node"),
        area(state.stick_area, 4)
    );
    say!(
        "  slips                {}, {}",
        counted(state.slipping_nodes, "node"),
        area(state.slip_area, 4)
    );
    say!("in a steady cycle between -T and T:");
    say!("  dissipation          {} a cycle", quantity(cycle.dissipation, "J", 4));
    say!("  secant stiffness     {}", quantity(cycle.secant_stiffness, "N/m", 4));
    say!("  loss factor          {:.3e}", cycle.loss_factor);
    if let Some(exponent) = joint.exponent {
        say!(
            "  power law            dissipation grows as amplitude to the {exponent:.2}, up to half of the sliding load"
        );
    }
    if let Some(sheared) = sheared {
        say!(
            "along the history of {} {} are lost",
            counted(sheared.rows.len(), "row"),
            quantity(sheared.dissipation(), "J", 4)
        );
    }
    if matches!(joint.record.kernel().origin, KernelOrigin::Other) {
        say!(
            "note: the kernel is not that of a half-space; the tangential one is taken to be κ times it"
        );
    }
    for warning in &joint.warnings {
        eprintln!("warning: {warning}");
    }
}
