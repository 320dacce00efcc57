// Colours of drawings and charts, light and dark; told apart with any one kind of cone missing.

const LIGHT = {
  name: "light",
  ground: "#ffffff",
  ink: "#17202b",
  muted: "#526070",
  grid: "#e4e8ed",
  pressure: "#0072b2",
  shear: "#c94a00",
  bound: "#7d8a98",
  upper: "#00705a",
  lower: "#a0489c",
  stick: "#d5e7f3",
  slip: "#fae0c5",
  core: "#cfd6de",
  coreEdge: "#8c98a5",
  air: "#f4f7fa",
  alert: "#a80020",
  upperTones: ["#4d9e8c", "#a9d6ca", "#2b7a68", "#7cbcac"],
  lowerTones: ["#b978b5", "#e0bfde", "#8f4a8b", "#cc9bc9"],
  designs: ["#0072b2", "#c94a00", "#00705a", "#a0489c"],
  sequential: [
    [0, "#fdfcf7"],
    [0.2, "#fddfa0"],
    [0.4, "#f9a26b"],
    [0.6, "#d9546c"],
    [0.8, "#8c2981"],
    [1, "#3b0f70"],
  ],
  diverging: [
    [0, "#1f5f99"],
    [0.25, "#7fb4da"],
    [0.5, "#f7f7f5"],
    [0.75, "#eba27a"],
    [1, "#a63a12"],
  ],
};
const DARK = {
  name: "dark",
  ground: "#171c22",
  ink: "#e8ecf1",
  muted: "#a7b2be",
  grid: "#2a323b",
  pressure: "#5cb8f0",
  shear: "#ff9d4d",
  bound: "#8d99a6",
  upper: "#4fd6b4",
  lower: "#dba6ee",
  stick: "#21384a",
  slip: "#4a3720",
  core: "#46505b",
  coreEdge: "#7d8894",
  air: "#1d242c",
  alert: "#ff8b95",
  upperTones: ["#2f8a74", "#5fb9a3", "#1f6353", "#479c87"],
  lowerTones: ["#9a5f9c", "#c795c9", "#70406f", "#b07ab1"],
  designs: ["#5cb8f0", "#ff9d4d", "#4fd6b4", "#dba6ee"],
  sequential: [
    [0, "#171c22"],
    [0.2, "#44196b"],
    [0.4, "#98317e"],
    [0.6, "#e25165"],
    [0.8, "#fca36e"],
    [1, "#fcfdbf"],
  ],
  diverging: [
    [0, "#8fc8f4"],
    [0.25, "#2f6ea6"],
    [0.5, "#171c22"],
    [0.75, "#a8501c"],
    [1, "#ffb782"],
  ],
};

/** The palette of a theme, "light" or "dark". */
export function paletteOf(theme) {
  return theme === "dark" ? DARK : LIGHT;
}

/** The fill of layer `i` of a roller. */
export function toneOf(side, i, palette) {
  const tones = side === "upper" ? palette.upperTones : palette.lowerTones;
  return tones[i % tones.length];
}
