// A page of its own: it shows what stands in it.

/** Says why there is nothing else. */
function refuse(error) {
  byId("all").hidden = true;
  byId("fault").hidden = false;
  byId("fault").textContent = error instanceof Fault ? error.message : `This page cannot be shown: ${error.message}`;
}

async function start() {
  let data;
  try {
    data = JSON.parse(byId("data").textContent);
  } catch (error) {
    throw new Fault("The file is incomplete: its data end early. Make it again, or fetch it again.");
  }
  byId("fault").hidden = true;
  await showPaths(data);
}

addEventListener("DOMContentLoaded", () => start().catch(refuse));
