// Two studies side by side, by their reports.
import { element } from "./dom.js";

document.getElementById("compare").append(element("p", {}, "Open the reports of two studies from the list of ", element("a", { href: "/" }, "studies"), "."));
