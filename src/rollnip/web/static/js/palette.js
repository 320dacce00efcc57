// Colours of drawings and charts, each light and dark; told apart with any one kind of cone missing.

const COLOURS = {
  ground: ["#ffffff", "#171c22"],
  ink: ["#17202b", "#e8ecf1"],
  muted: ["#526070", "#a7b2be"],
  grid: ["#e4e8ed", "#2a323b"],
  pressure: ["#0072b2", "#5cb8f0"],
  shear: ["#c94a00", "#ff9d4d"],
  bound: ["#7d8a98", "#8d99a6"],
  upper: ["#00705a", "#4fd6b4"],
  lower: ["#a0489c", "#dba6ee"],
  stick: ["#d5e7f3", "#21384a"],
  slip: ["#fae0c5", "#4a3720"],
  core: ["#cfd6de", "#46505b"],
  coreEdge: ["#8c98a5", "#7d8894"],
  sheet: ["#fff3c4", "#efdfa6"],
  sheetLine: ["#7a5a00", "#ecd27a"],
  air: ["#f4f7fa", "#1d242c"],
  alert: ["#a80020", "#ff8b95"],
  upperTones: [
    ["#4d9e8c", "#a9d6ca", "#2b7a68", "#7cbcac"],
    ["#2f8a74", "#5fb9a3", "#1f6353", "#479c87"],
  ],
  lowerTones: [
    ["#b978b5", "#e0bfde", "#8f4a8b", "#cc9bc9"],
    ["#9a5f9c", "#c795c9", "#70406f", "#b07ab1"],
  ],
  designs: [
    ["#0072b2", "#c94a00", "#00705a", "#a0489c"],
    ["#5cb8f0", "#ff9d4d", "#4fd6b4", "#dba6ee"],
  ],
  sequential: [
    scale("#fdfcf7", "#fddfa0", "#f9a26b", "#d9546c", "#8c2981", "#3b0f70"),
    scale("#171c22", "#44196b", "#98317e", "#e25165", "#fca36e", "#fcfdbf"),
  ],
  diverging: [
    scale("#1f5f99", "#7fb4da", "#f7f7f5", "#eba27a", "#a63a12"),
    scale("#8fc8f4", "#2f6ea6", "#171c22", "#a8501c", "#ffb782"),
  ],
};
const LIGHT = column("light", 0);
const DARK = column("dark", 1);

/** The palette of a theme, "light" or "dark". */
export function paletteOf(theme) {
  return theme === "dark" ? DARK : LIGHT;
}

/** The fill of layer `i` of a roller. */
export function toneOf(side, i, palette) {
  const tones = side === "upper" ? palette.upperTones : palette.lowerTones;
  return tones[i % tones.length];
}

/** Colours at equal steps from 0 to 1. */
function scale(...colours) {
  return colours.map((colour, i) => [i / (colours.length - 1), colour]);
}

function column(name, which) {
  const picked = Object.entries(COLOURS).map(([role, both]) => [role, both[which]]);
  return { name, ...Object.fromEntries(picked) };
}
