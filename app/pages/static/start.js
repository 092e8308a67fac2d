// The start page: one click to a study of the example, and the studies so far.
import { tryExample } from "./study/example.js";
import { showError } from "./base/problem.js";
import { showStudies } from "./study/studies.js";

const said = document.getElementById("said");

for (const button of document.querySelectorAll("[data-example]")) {
  button.addEventListener("click", async () => {
    const words = button.textContent;
    for (const one of document.querySelectorAll("[data-example]")) one.disabled = true;
    button.textContent = "Uploading the log …";
    try {
      const job = await tryExample(button.dataset.example);
      location.assign(`/studies/${job.id}`);
    } catch (error) {
      showError(said, error);
    } finally {
      button.textContent = words;
      for (const one of document.querySelectorAll("[data-example]")) one.disabled = false;
    }
  });
}

showStudies(document.getElementById("studies"));
