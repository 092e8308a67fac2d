// The way to a new study: a robot, one log or several, a question. Each part tells what was chosen; this page holds it.
import { askQuestion } from "./study/question.js";
import { chooseLogs } from "./log/logs.js";
import { chooseRobot } from "./robot/robots.js";

const wanted = new URLSearchParams(location.search);
const question = askQuestion(document.getElementById("question"));
const logs = chooseLogs(document.getElementById("log"), {
  wanted: wanted.getAll("log"),
  chosen: (all) => question.use({ logs: all }),
});
chooseRobot(document.getElementById("robot"), {
  wanted: wanted.get("robot"),
  chosen: (robot) => {
    logs.use(robot);
    question.use({ robot });
  },
});
