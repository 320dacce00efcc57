// The views under the tabs.

import { CompareView } from "./compare.js";
import { CurveView } from "./curves.js";
import { FaceView } from "./faceview.js";
import { FindView } from "./find.js";
import { HeatView } from "./heatview.js";
import { InsideView } from "./inside.js";
import { MeasuredView } from "./measured.js";
import { PatchView } from "./patchview.js";
import { say } from "./texts.js";
import { WhatIfView } from "./whatif.js";

/** One view for each tab, in their order. */
export function viewsOf(app) {
  return [
    new CurveView("pressure", say("tab.pressure"), app),
    new CurveView("gap", say("tab.gap"), app),
    new CurveView("strain", say("tab.strain"), app),
    new CurveView("speed", say("tab.speed"), app),
    new CurveView("sheet", say("tab.sheet"), app),
    new FaceView(app),
    new HeatView(app),
    new InsideView(app),
    new WhatIfView(app),
    new FindView(app),
    new MeasuredView(app),
    new PatchView(app),
    new CompareView(app),
  ];
}
