// A path: which nodes are in contact at every event, and the scalars there.

const TOUCH = 0, RELEASE = 1, YIELD = 3;

class ContactPath {
  static async of(record) {
    const path = new ContactPath();
    await path.read(record);
    return path;
  }

  async read(record) {
    const { nx, ny, events } = record;
    demand(isCount(nx) && isCount(ny) && nx * ny > 0 && nx * ny < 2 ** 27, "The file is damaged: its grid has no size.");
    demand(events && isCount(events.count) && events.count > 0, "The record has no state.");
    Object.assign(this, { record, nx, ny, size: nx * ny, count: events.count });
    this.nodes = await planes(events.nodes, this.count, "the nodes of the events");
    this.kinds = await planes(events.kinds, this.count, "the kinds of the events");
    this.columns = {};
    for (const [name, blob] of Object.entries(events.columns)) this.columns[name] = await column(blob, this.count, `the column ${name}`);
    demand(this.columns.load && this.columns.approach && this.columns.mean_gap, "The file is damaged: load, approach or mean gap are missing.");
    this.follow();
    const nominal = record.nominal_area;
    this.columns.mean_pressure = this.columns.load.map((load) => load / nominal);
    this.columns.area = Float64Array.from(this.contactNodes, (nodes) => nodes / this.size);
    if (this.hasYielded) this.columns.yielded = Float64Array.from(this.yieldedNodes, (nodes) => nodes / this.size);
    const { largest_patch: largest } = this.columns;
    if (largest) this.columns.largest_share = largest.map((nodes, i) => nodes / this.contactNodes[i]);
    this.heights = new Uint8Array(this.size);
    levelsOf(await inflate(record.heights.data, "the surface"), 0, () => true, nx, this.heights);
    await this.readFields(record.fields);
  }

  /** Whether it begins as another path that is shorter or as long. */
  continues(other) {
    const { nx, ny, count, nodes } = other;
    return nx === this.nx && ny === this.ny && count <= this.count && nodes.every((node, event) => node === this.nodes[event] || event === count - 1);
  }

  /** Nodes in contact after each event, and what it takes to undo it. */
  follow() {
    const { count, size } = this;
    this.touched = new Int32Array(size).fill(-1);
    this.yielded = new Int32Array(size).fill(-1);
    this.before = new Int32Array(count).fill(-1);
    this.first = new Int32Array(size).fill(-1);
    this.contactNodes = new Uint32Array(count);
    this.yieldedNodes = new Uint32Array(count);
    let inContact = 0, yielded = 0;
    for (let event = 0; event < count; event++) {
      const node = this.nodes[event], kind = this.kinds[event];
      demand(node < size, `The record is damaged: event ${event + 1} is outside the grid.`);
      const isIn = this.touched[node] >= 0;
      demand(kind === TOUCH ? !isIn : isIn || kind === 2, `The record is damaged: event ${event + 1} cannot happen to its node.`);
      this.before[event] = this.touched[node];
      if (kind === TOUCH) {
        this.touched[node] = event;
        if (this.first[node] < 0) this.first[node] = event;
        inContact++;
      } else if (kind === RELEASE) {
        this.touched[node] = -1;
        inContact--;
      } else if (kind === YIELD) {
        this.yielded[node] = event;
        yielded++;
      }
      this.contactNodes[event] = inContact;
      this.yieldedNodes[event] = yielded;
    }
    this.hasYielded = yielded > 0;
    this.present = count - 1;
  }

  /** To the state after an event. */
  goTo(event) {
    while (this.present < event) {
      const next = ++this.present, node = this.nodes[next], kind = this.kinds[next];
      if (kind === TOUCH) this.touched[node] = next;
      else if (kind === RELEASE) this.touched[node] = -1;
      else if (kind === YIELD) this.yielded[node] = next;
    }
    while (this.present > event) {
      const last = this.present--, node = this.nodes[last], kind = this.kinds[last];
      if (kind === YIELD) this.yielded[node] = -1;
      else if (kind === TOUCH || kind === RELEASE) this.touched[node] = this.before[last];
    }
  }

  async readFields(fields) {
    this.states = [];
    if (!fields) return;
    const { states, levels } = fields;
    const left = await inflate(fields.data, "pressure and gap");
    demand(left.length === states.length * this.size, "The file is damaged: pressure and gap are incomplete.");
    const end = this.present;
    states.forEach((state, i) => {
      demand(isCount(state.event) && state.event < this.count, "The file is damaged: a state with pressure is not on the path.");
      this.goTo(state.event);
      const codes = new Uint8Array(this.size);
      const { touched } = this;
      levelsOf(left, i * this.size, (node) => touched[node] >= 0, this.nx, codes);
      const isIn = Uint8Array.from(touched, (event) => (event >= 0 ? 1 : 0));
      this.states.push({ ...state, codes, isIn, levels, number: i + 1 });
    });
    this.goTo(end);
    if (!states.length) return;
    this.columns.greatest_pressure = new Float64Array(this.count).fill(NaN);
    for (const { event, pressure } of this.states) this.columns.greatest_pressure[event] = pressure;
  }

  /** The state with pressure and gap that is nearest to an event, by load. */
  nearest(event) {
    const load = this.columns.load;
    const far = (state) => Math.abs(load[state.event] - load[event]);
    return this.states.reduce((best, state) => (best && far(best) <= far(state) ? best : state), null);
  }

  /** Pressure or gap of a node at a state, of which there is one. */
  fieldAt(state, node) {
    const part = state.codes[node] / state.levels;
    return state.isIn[node] ? { pressure: part * part * state.pressure } : { gap: part * part * state.gap };
  }

  heightOf(node) {
    const { least, greatest, levels } = this.record.heights;
    return least + (this.heights[node] / levels) * (greatest - least);
  }

  /** The last event up to which a quantity that grows is not above a value. */
  eventAt(name, value) {
    const grown = this.grown(name);
    let [low, high] = [0, this.count - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (grown[middle] <= value) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** A quantity, where it falls as it was before. */
  grown(name) {
    this.growing ??= {};
    return (this.growing[name] ??= this.columns[name].slice().map(((most) => (value) => (most = Math.max(most, value)))(-Infinity)));
  }
}
