// How a design is looked at, and what of it is no part of a case file.

export const VIEW = {
  tab: "pressure",
  system: "metric",
  inside: { roller: "upper", field: "mises" },
  whatif: { path: "nip.load", answer: "nip_width" },
  find: { path: "nip.load", answer: "nip_width" },
  compare: { profile: "pressure" },
  families: {}, // kind of covering by path of a material
  measured: {}, // {modulus, band} by path of a material
  machine: { bore: 50, count: 2, ratio: 1 }, // cylinders that press [mm]
  face: { curve: "load", roller: "upper" },
  heat: { parameter: "speed" },
  press: "load",
  keeps: { upper: "diameter", lower: "diameter" },
};

/** How a state from outside wants to be looked at; what is missing or odd is as usual. */
export function viewOf(state) {
  const entries = Object.entries(VIEW).map(([key, usual]) => {
    const given = state[key] ?? usual;
    return [key, typeof usual === "string" ? String(given) : { ...usual, ...given }];
  });
  const view = Object.fromEntries(entries);
  return { ...view, system: view.system === "us" ? "us" : "metric" };
}
