//! The watched nodes of a window: what each does until something happens, and what an event changes.

use super::answers::Answers;
use super::law::CohesiveLaw;
use super::state::NodeState;

/// Pivots below this part of what a node alone has count as unstable.
const LEAST_PIVOT: f64 = 1e-10;
/// A window ends behind a pivot below this part: what it made of the matrix has lost three digits, and energies are to
/// be known to 1e-12.
const SMALL_PIVOT: f64 = 1e-3;
/// Nodes within this part of the range, or of the stress, of an event have it together.
const TIE: f64 = 1e-13;
/// How far a pull may be from its law where a node that is carried is put on that, and from an end of the law where a
/// node is held there, relative to the stress. Energies are stationary at the law: they miss its square.
pub(super) const LAG: f64 = 1e-10;

/// A watched node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) node: usize,
    pub(super) state: NodeState,
    pub(super) pressure: f64,
    pub(super) gap: f64,
}

/// A node whose traction is held within a jump.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    pub(super) node: usize,
    /// \[Pa\].
    pub(super) pull: f64,
    /// Which way the pull goes to the law: 1, it grows, where the gap was closing, and −1 where it was opening. If pulls
    /// may open gaps, this need not be the way of the branch.
    pub(super) way: f64,
}

/// Something that happens to a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Change {
    pub(crate) node: usize,
    pub(crate) from: NodeState,
    pub(crate) to: NodeState,
}

/// Pressures and gaps of watched nodes along a parameter, with the matrix of how each answers to the others.
///
/// Of every node one of two quantities is given and the other answers. Where its gap is 0 the pressure answers,
/// elsewhere the gap, to a pressure that is given; on the slope of the law, p = k (gap − h₂), −k h₂ is given of the
/// pressure. A node that touches or parts is a pivot of the matrix, positive in a stable state; so is 1 − k T_ss where
/// one becomes soft. Soft nodes that are not watched answer all the time.
#[derive(Debug, Clone)]
pub(super) struct Board {
    law: CohesiveLaw,
    pub(super) rows: Vec<Row>,
    answers: Answers,
    /// Rates along the parameter of what answers, and of the sums of all pressures and of all gaps.
    along: Vec<f64>,
    /// The same along the approach while the pull of a row is the parameter, if the window has begun along the
    /// approach.
    along_approach: Option<Vec<f64>>,
    /// Sums of all pressures and of all gaps.
    pub(super) sums: [f64; 2],
    /// Nodes whose traction is held, those that are carried first.
    pub(super) held: Vec<Hold>,
    /// The row whose pull is the parameter, if one is, and whether that grows, 1, or falls, −1.
    carried: Option<(usize, f64)>,
    /// Nodes in contact, on the whole grid.
    pub(super) contact_nodes: usize,
    /// Soft nodes that are not watched.
    other_soft: usize,
    /// Whether a pivot was so small that the window should end.
    pub(super) is_worn: bool,
    pub(super) changes: Vec<Change>,
}

/// What a window begins with.
pub(super) struct Beginning {
    pub(super) law: CohesiveLaw,
    pub(super) rows: Vec<Row>,
    pub(super) answers: Answers,
    /// By row: how fast its quantity that answers grows along the parameter.
    pub(super) rates: Vec<f64>,
    /// Sums of all pressures and of all gaps, with their rates.
    pub(super) sums: [[f64; 2]; 2],
    pub(super) held: Vec<Hold>,
    pub(super) contact_nodes: usize,
    /// Soft nodes that are not watched.
    pub(super) other_soft: usize,
}

impl Board {
    pub(super) fn new(begin: Beginning) -> Self {
        let rates = begin.rates.iter().copied().chain(begin.sums.iter().map(|[_, rate]| *rate));
        let mut board = Self {
            law: begin.law,
            along: rates.collect(),
            along_approach: None,
            rows: begin.rows,
            answers: begin.answers,
            sums: begin.sums.map(|[value, _]| value),
            held: begin.held,
            carried: None,
            contact_nodes: begin.contact_nodes,
            other_soft: begin.other_soft,
            is_worn: false,
            changes: Vec::new(),
        };
        board.carried = board.first_held();
        board
    }

    /// The row of the first node that is held, and which way its pull goes to its law.
    fn first_held(&self) -> Option<(usize, f64)> {
        let &Hold { node, way, .. } = self.held.first()?;
        let place = self.rows.iter().position(|row| row.node == node)?;
        let Row { pressure, gap, .. } = self.rows[place];
        Some((place, self.law.direction([pressure, gap], way)))
    }

    fn size(&self) -> usize {
        self.rows.len()
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        self.answers.entry(row, column)
    }

    /// Exchanges what is given of a node and what answers.
    fn pivot(&mut self, place: usize) {
        let rates = [&mut self.along].into_iter().chain(self.along_approach.as_mut());
        self.answers.pivot(place, rates);
    }

    /// Puts a node whose pressure is given on the slope of the law.
    fn soften(&mut self, place: usize) {
        self.feed_back(place, self.law.slope());
    }

    /// Takes it off the slope.
    fn harden(&mut self, place: usize) {
        self.feed_back(place, -self.law.slope());
    }

    fn feed_back(&mut self, place: usize, stiffness: f64) {
        let rates = [&mut self.along].into_iter().chain(self.along_approach.as_mut());
        self.answers.feed_back(place, stiffness, rates);
    }

    /// 1 − k T_ss of a node whose pressure is given: positive if it would be stable on the slope.
    fn stability(&self, place: usize) -> f64 {
        1.0 - self.law.slope() * self.entry(place, place)
    }

    /// Rates of pressure and gap.
    pub(super) fn rates(&self, place: usize) -> [f64; 2] {
        let rate = self.along[place];
        match (self.rows[place].state, self.carried) {
            (NodeState::Contact, _) => [rate, 0.0],
            (NodeState::Soft, _) => [rate * self.law.slope(), rate],
            (_, Some((carried, direction))) if carried == place => [-direction, rate],
            _ => [0.0, rate],
        }
    }

    /// Rates of the sums of all pressures and of all gaps.
    pub(super) fn sum_rates(&self) -> [f64; 2] {
        [0, 1].map(|k| self.along[self.size() + k])
    }

    /// When something happens next, to which row: of those that tie the one of the lowest node.
    pub(super) fn next(&self) -> Option<(f64, usize)> {
        let times = (0..self.size()).filter_map(|place| {
            let left = self.left(place)?;
            Some((left.time(), place))
        });
        let times: Vec<(f64, usize)> = times.collect();
        let &(first, place) = times.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let tied = times.iter().filter(|&&(time, place)| {
            time == first || self.left(place).is_some_and(|left| left.is_by(first, TIE))
        });
        let lowest = tied.map(|&(_, place)| place).min_by_key(|&place| self.rows[place].node);
        Some((first, lowest.unwrap_or(place)))
    }

    /// Whether something happens to a row at once, but for rounding.
    pub(super) fn is_due(&self, place: usize) -> bool {
        self.left(place).is_some_and(|left| left.is_by(0.0, LAG))
    }

    fn left(&self, place: usize) -> Option<Left> {
        let row = &self.rows[place];
        let [dp, dgap] = self.rates(place);
        Left::of(&self.law, row.state, [row.pressure, row.gap], [dp, dgap])
    }

    /// Whether the event that comes next to a row closes its gap.
    pub(super) fn closes(&self, place: usize) -> bool {
        self.rates(place)[1] < 0.0
    }

    /// Goes on along the parameter. Returns the energy that the traction of held nodes loses against their law, over
    /// the area of a cell.
    pub(super) fn advance(&mut self, step: f64) -> f64 {
        let mut lost = 0.0;
        for place in 0..self.size() {
            let [dp, dgap] = self.rates(place);
            let row = self.rows[place];
            let [pressure, gap] = [row.pressure + step * dp, row.gap + step * dgap];
            lost += self.lost(&row, [pressure, gap]);
            self.rows[place] = Row { pressure, gap, ..row };
        }
        let rates = self.sum_rates();
        self.sums.iter_mut().zip(rates).for_each(|(sum, rate)| *sum += step * rate);
        if let (Some((place, _)), Some(hold)) = (self.carried, self.held.first_mut()) {
            hold.pull = -self.rows[place].pressure;
        }
        lost
    }

    /// What the traction of a row loses against its law on a straight way to this pressure and gap; nothing but for held
    /// nodes.
    fn lost(&self, row: &Row, [pressure, gap]: [f64; 2]) -> f64 {
        if row.state != NodeState::Held {
            return 0.0;
        }
        let change = self.law.energy(gap) - self.law.energy(row.gap);
        -(change + 0.5 * (row.pressure + pressure) * (gap - row.gap))
    }

    /// What held nodes lose on the way from where the rows have led to the solution there, pressure and gap of a node.
    /// Near an instability that is long: the lag of one pull, over the least pivot.
    pub(super) fn lost_to(&self, solution: impl Fn(usize) -> [f64; 2]) -> f64 {
        self.rows.iter().map(|row| self.lost(row, solution(row.node))).sum()
    }

    fn change(&mut self, place: usize, to: NodeState) {
        let Row { node, state: from, .. } = self.rows[place];
        self.changes.push(Change { node, from, to });
        let row = &mut self.rows[place];
        row.state = to;
        match to {
            NodeState::Open => row.pressure = 0.0,
            NodeState::Cohesive => row.pressure = -self.law.stress(),
            NodeState::Contact => row.gap = 0.0,
            NodeState::Soft | NodeState::Held => {}
        }
        if from == NodeState::Contact {
            self.contact_nodes -= 1;
        } else if to == NodeState::Contact {
            self.contact_nodes += 1;
        }
    }

    /// Holds the traction of a row: at an end of the law that it ties with, or else what rounding made of it would grow
    /// from each node that turns unstable there to the next.
    fn hold(&mut self, place: usize, pull: f64, way: f64) {
        let stress = self.law.stress();
        let end = [0.0, stress].into_iter().find(|end| (pull - end).abs() <= LAG * stress);
        let pull = end.unwrap_or(pull);
        self.change(place, NodeState::Held);
        self.rows[place].pressure = -pull;
        self.held.push(Hold { node: self.rows[place].node, pull, way });
    }

    fn note_pivot(&mut self, part: f64) {
        self.is_worn |= part.abs() < SMALL_PIVOT;
    }

    /// Puts a row on the slope, from the end with this pull, or holds its traction if it is not stable there.
    fn soften_or_hold(&mut self, place: usize, pull: f64) {
        let stability = self.stability(place);
        if stability > LEAST_PIVOT {
            self.note_pivot(stability);
            self.soften(place);
            self.change(place, NodeState::Soft);
        } else {
            self.hold(place, pull, if pull > 0.0 { -1.0 } else { 1.0 });
        }
    }

    fn touch(&mut self, place: usize) {
        self.note_pivot(self.entry(place, place) / self.law.compliance());
        self.pivot(place);
        self.change(place, NodeState::Contact);
    }

    /// Carries out the event that comes next to a row.
    pub(super) fn happen(&mut self, place: usize) {
        let closes = self.closes(place);
        let stress = self.law.stress();
        let is_triangle = self.law.flat_range() == 0.0;
        match self.rows[place].state {
            NodeState::Open => self.soften_or_hold(place, 0.0),
            NodeState::Soft => {
                self.harden(place);
                if !closes {
                    self.change(place, NodeState::Open);
                } else if is_triangle {
                    self.rows[place].pressure = -stress;
                    self.touch(place);
                } else {
                    self.change(place, NodeState::Cohesive);
                }
            }
            NodeState::Cohesive if !closes => self.soften_or_hold(place, stress),
            NodeState::Cohesive => self.touch(place),
            NodeState::Held => {
                let node = self.rows[place].node;
                self.held.retain(|hold| hold.node != node);
                self.carried = self.carried.filter(|&(carried, _)| carried != place);
                self.touch(place);
            }
            NodeState::Contact => self.part(place),
        }
    }

    /// Whether a jump begins with what comes next to a row.
    pub(super) fn begins_jump(&self, place: usize) -> bool {
        let mut after = self.clone();
        after.happen(place);
        !after.held.is_empty()
    }

    /// Whether other soft nodes have to be held for what happens next to a row, and some soft nodes are not watched.
    pub(super) fn lacks_others(&self, place: usize) -> bool {
        self.rows[place].state == NodeState::Contact
            && self.other_soft > 0
            && self.stiffness(place) <= LEAST_PIVOT
    }

    /// The pressure that a gap of a node in contact makes, over that of a node alone: positive if it may part.
    fn stiffness(&self, place: usize) -> f64 {
        self.entry(place, place) * self.law.compliance()
    }

    /// Lets a node part. Where soft nodes would not be stable then, those whose traction it would change most are held
    /// first. Their gaps open with its own, but where pulls may open gaps some close.
    fn part(&mut self, place: usize) {
        let mut part = self.stiffness(place);
        while part.is_nan() || part <= LEAST_PIVOT {
            let soft = (0..self.size()).filter(|&row| self.rows[row].state == NodeState::Soft);
            let column = self.answers.column(place);
            let most = soft.max_by(|&a, &b| column[a].abs().total_cmp(&column[b].abs()));
            let Some(row) = most else {
                break;
            };
            let way = if column[row] < 0.0 { 1.0 } else { -1.0 };
            self.harden(row);
            self.hold(row, -self.rows[row].pressure, way);
            part = self.stiffness(place);
        }
        self.note_pivot(part);
        self.pivot(place);
        let stress = self.law.stress();
        self.rows[place].pressure = -stress;
        if self.law.flat_range() == 0.0 {
            self.soften_or_hold(place, stress);
        } else {
            self.change(place, NodeState::Cohesive);
        }
    }

    /// Makes the pull of the first node that is held the parameter.
    pub(super) fn carry_next(&mut self) {
        if let Some((place, direction)) = self.first_held() {
            self.carried = Some((place, direction));
            let mut rates = self.answers.column(place);
            rates.iter_mut().for_each(|rate| *rate *= -direction);
            let before = std::mem::replace(&mut self.along, rates);
            self.along_approach.get_or_insert(before);
        }
    }

    /// Makes the approach the parameter again.
    pub(super) fn end_carrying(&mut self) {
        self.carried = None;
        if let Some(rates) = self.along_approach.take() {
            self.along = rates;
        }
    }

    /// How far the pull of the carried row may go before its own law, or an end of that, comes first; `None` once it is
    /// back on its law, stable, or was none.
    pub(super) fn carry(&mut self) -> Option<Carry> {
        let (place, direction) = self.carried?;
        let law = self.law;
        let (gap, pull) = (self.rows[place].gap, -self.rows[place].pressure);
        let corner = law.gap_of(LAG);
        let grows = direction > 0.0;
        let on_slope = if grows {
            gap <= law.range() + corner && gap > law.flat_range() + corner
        } else {
            // A triangle has nothing below its slope: there a gap below 0 is rounding.
            let is_above = law.flat_range() == 0.0 || gap >= law.flat_range() - corner;
            is_above && gap < law.range() - corner
        };
        let lag = direction * (law.pull(gap) - pull);
        let gain = if on_slope { self.stability(place) } else { 1.0 };
        if lag <= LAG * law.stress() && gain > 0.0 {
            self.held.remove(0);
            self.carried = None;
            if on_slope {
                self.note_pivot(gain);
                self.soften(place);
                self.change(place, NodeState::Soft);
            } else if gap <= law.flat_range() + 2.0 * corner {
                self.change(place, NodeState::Cohesive);
            } else {
                self.change(place, NodeState::Open);
            }
            return None;
        }
        let rate = self.rates(place)[1];
        let corners = [law.flat_range(), law.range()].map(|level| (level - gap) / rate);
        let corners = corners.into_iter().filter(|&step| step > corner / rate.abs());
        Some(Carry {
            corner: corners.fold(f64::INFINITY, f64::min),
            law: if gain > 0.0 { lag / gain } else { f64::INFINITY },
            end: (if grows { law.stress() - pull } else { pull }).max(0.0),
        })
    }

    /// Lets go of the carried row at the end of the range of pulls, where it has passed the corner of its law.
    pub(super) fn let_go(&mut self) {
        if let Some((place, direction)) = self.carried.take() {
            self.held.remove(0);
            let to = if direction > 0.0 { NodeState::Cohesive } else { NodeState::Open };
            self.change(place, to);
        }
    }

    pub(super) fn law(&self) -> &CohesiveLaw {
        &self.law
    }

    /// Whether the parameter is the pull of a row still.
    pub(super) fn carries(&self) -> bool {
        self.carried.is_some()
    }

    /// Nodes on the slope, and those pulled with the greatest stress.
    pub(super) fn pulled(&self) -> [usize; 2] {
        let [soft, cohesive] = [NodeState::Soft, NodeState::Cohesive]
            .map(|state| self.rows.iter().filter(|row| row.state == state).count());
        [soft + self.other_soft, cohesive]
    }

    /// The energy of adhesion of all nodes but soft ones that are not watched, over the area of a cell.
    pub(super) fn energy(&self) -> f64 {
        let pulled = self.rows.iter().map(|row| match row.state {
            NodeState::Soft => -0.5 * row.pressure * row.pressure / self.law.slope(),
            NodeState::Cohesive | NodeState::Held => self.law.energy(row.gap),
            NodeState::Open | NodeState::Contact => 0.0,
        });
        pulled.sum::<f64>() - self.law.work() * self.contact_nodes as f64
    }
}

/// Steps of the pull of a row that is carried.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carry {
    /// To the next corner of its law.
    pub(super) corner: f64,
    /// To its law.
    pub(super) law: f64,
    /// To the greatest pull, or to none.
    pub(super) end: f64,
}

/// What is left to the next event of a node: a distance, how fast it falls, and the unit of both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Left {
    distance: f64,
    rate: f64,
    unit: f64,
}

impl Left {
    /// `None` if nothing happens to the node along these rates.
    pub(super) fn of(
        law: &CohesiveLaw,
        state: NodeState,
        [pressure, gap]: [f64; 2],
        [dp, dgap]: [f64; 2],
    ) -> Option<Self> {
        let (flat, range) = (law.flat_range(), law.range());
        let falls_to = |level: f64| Some([gap - level, -dgap]);
        let rises_to = |level: f64| Some([level - gap, dgap]);
        let [distance, rate] = match state {
            NodeState::Open if dgap < 0.0 => falls_to(range),
            NodeState::Soft if dgap < 0.0 => falls_to(flat),
            NodeState::Soft if dgap > 0.0 => rises_to(range),
            NodeState::Cohesive | NodeState::Held if dgap < 0.0 => falls_to(0.0),
            NodeState::Cohesive if dgap > 0.0 => rises_to(flat),
            NodeState::Contact if dp < 0.0 => {
                let distance = pressure + law.stress();
                return Some(Self { distance, rate: -dp, unit: law.stress() });
            }
            _ => None,
        }?;
        Some(Self { distance, rate, unit: range })
    }

    /// Whether the event has come at a time, but for a part of the unit.
    pub(super) fn is_by(&self, time: f64, part: f64) -> bool {
        self.distance - time * self.rate <= part * self.unit
    }

    /// How long it is until then.
    pub(super) fn time(&self) -> f64 {
        (self.distance / self.rate).max(0.0)
    }
}
