// Files that the page saves, and what it copies.

function saveBlob(name, blob) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name.replace(/[^\w.\- ]+/g, "_") });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const saveText = (name, type, text) => saveBlob(name, new Blob([text], { type: `${type};charset=utf-8` }));

/** The table on the clipboard, or selected where there is none. */
async function copied(text, table) {
  try {
    await navigator.clipboard.writeText(text);
    return "copied";
  } catch (error) {
    const selection = getSelection();
    selection.selectAllChildren(table);
    return "selected: copy it with Ctrl-C";
  }
}

/** The map with its marks, its colour bar and what it shows. */
function saveMap(view) {
  const { path, event } = view, { record } = path;
  const side = 1200, ratio = shown(record.lx, record.ly);
  const [width, height] = ratio > 1 ? [side, Math.round(side / ratio)] : [Math.round(side * ratio), side];
  const picture = make("canvas", { width: Math.max(width, 700) + 40, height: height + 190 });
  const context = picture.getContext("2d");
  context.fillStyle = ink("--paper");
  context.fillRect(0, 0, picture.width, picture.height);
  const marks = make("canvas", { width, height });
  drawMarks(marks.getContext("2d"), width, height, 2, view);
  context.imageSmoothingEnabled = false;
  context.drawImage(view.canvas, 20, 60, width, height);
  context.drawImage(marks, 20, 60);
  context.fillStyle = ink("--ink");
  context.font = "24px system-ui, sans-serif";
  const most = picture.width - 40;
  context.fillText(`${quantity(path.columns.load[event], "N")}, ${quantity(path.columns.mean_pressure[event], "Pa")}: ${path.contactNodes[event]} nodes in contact, ${digits(100 * path.columns.area[event])} %`, 20, 40, most);
  context.font = "18px system-ui, sans-serif";
  const below = height + 80;
  if (!view.bar.hidden) {
    context.drawImage(view.bar, 20, below, width, 24);
    const ticks = [...view.ticks.children].map((tick) => tick.textContent);
    ticks.forEach((words, i) => {
      context.textAlign = i === 0 ? "left" : i === ticks.length - 1 ? "right" : "center";
      context.fillText(words, 20 + (width * i) / (ticks.length - 1), below + 46);
    });
  }
  context.textAlign = "left";
  context.fillText([...view.key.children].map((part) => part.textContent).join("; "), 20, below + 78, most);
  context.fillText(record.name, 20, below + 102, most);
  picture.toBlob((blob) => saveBlob(`contact at event ${event + 1}.png`, blob), "image/png");
}

const escaped = (text) => String(text).replace(/[&<>"']/g, (letter) => `&#${letter.charCodeAt(0)};`);

/** A chart as a drawing: what uPlot has drawn, with its axes and lines. */
function svgOf(chart, { inkColour = "#111", gridColour = "#ccc" } = {}) {
  const { plot, x, y, lines, title } = chart;
  const ratio = uPlot.pxRatio;
  const box = Object.fromEntries(Object.entries(plot.bbox).map(([name, value]) => [name, value / ratio]));
  const top = 26, legend = 18 * lines.length * (lines.length > 1 ? 1 : 0);
  const width = plot.width, height = plot.height + top + legend;
  const at = (value, scale) => plot.valToPos(value, scale) + (scale === "x" ? box.left : box.top + top);
  const parts = [`<rect width="${width}" height="${height}" fill="#fff"/>`, `<text x="${box.left}" y="17" font-weight="600">${escaped(title)}</text>`];
  plot.axes.forEach((axis, i) => {
    const scale = i === 0 ? "x" : "y";
    (axis._splits ?? []).forEach((value, k) => {
      if (value === null) return;
      const place = at(value, scale), words = axis._values?.[k];
      const line = i === 0 ? `x1="${place}" x2="${place}" y1="${box.top + top}" y2="${box.top + top + box.height}"` : `y1="${place}" y2="${place}" x1="${box.left}" x2="${box.left + box.width}"`;
      if (words) parts.push(`<line ${line} stroke="${gridColour}"/>`);
      if (words) parts.push(i === 0 ? `<text x="${place}" y="${box.top + top + box.height + 15}" text-anchor="middle">${escaped(words)}</text>` : `<text x="${box.left - 6}" y="${place + 4}" text-anchor="end">${escaped(words)}</text>`);
    });
  });
  const label = (axis) => escaped(`${axis.words ?? ""}${axis.in.name ? ` [${axis.in.name}]` : ""}`.trim());
  parts.push(`<text x="${box.left + box.width / 2}" y="${box.top + top + box.height + 34}" text-anchor="middle">${label(x)}</text>`);
  const middle = box.top + top + box.height / 2;
  parts.push(`<text transform="translate(12 ${middle}) rotate(-90)" text-anchor="middle">${label(y)}</text>`);
  parts.push(`<rect x="${box.left}" y="${box.top + top}" width="${box.width}" height="${box.height}" fill="none" stroke="${gridColour}"/>`);
  lines.forEach((line, i) => {
    const drawn = chart.traces[i] ?? chart.data[0].map((value, k) => [value, chart.data[i + 1][k]]);
    const points = drawn.filter(([, value]) => value !== null && value !== undefined);
    const trace = points.map(([a, b], k) => `${k ? "L" : "M"}${at(a, "x").toFixed(2)} ${at(b, "y").toFixed(2)}`).join("");
    const dash = DASHES[line.dash].length ? ` stroke-dasharray="${DASHES[line.dash].join(" ")}"` : "";
    parts.push(`<path d="${trace}" fill="none" stroke="${line.colour}" stroke-width="1.8"${dash}/>`);
    if (lines.length > 1) {
      const row = plot.height + top + 18 * i + 6;
      parts.push(`<line x1="${box.left}" x2="${box.left + 26}" y1="${row}" y2="${row}" stroke="${line.colour}" stroke-width="1.8"${dash}/>`, `<text x="${box.left + 32}" y="${row + 4}">${escaped(line.label)}</text>`);
    }
  });
  if (chart.place !== undefined) {
    const place = at(chart.place / x.in.factor, "x");
    if (place >= box.left && place <= box.left + box.width + 1) parts.push(`<line x1="${place}" x2="${place}" y1="${box.top + top}" y2="${box.top + top + box.height}" stroke="#d6006c"/>`);
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-family="system-ui, sans-serif" font-size="12" fill="${inkColour}">${parts.join("")}</svg>\n`;
}
