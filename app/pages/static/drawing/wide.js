// Let wide content scroll by itself, and let it be reached by keys to do so.
import { element } from "../base/dom.js";

/** Put something wide into a region of its own that scrolls. */
export function wide(content, label) {
  return scrolling(element("div", { class: "wide" }, content), label);
}

/** Make an element a region that scrolls. */
export function scrolling(region, label) {
  region.tabIndex = 0;
  region.setAttribute("role", "region");
  region.setAttribute("aria-label", label);
  return region;
}
