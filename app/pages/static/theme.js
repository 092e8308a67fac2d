// Dark or light: as the system says, unless the reader chose. It runs before the page is drawn, so nothing flashes.
(() => {
  const stored = () => {
    try {
      return localStorage.getItem("theme");
    } catch {
      return null;
    }
  };
  const root = document.documentElement;
  const systemDark = matchMedia("(prefers-color-scheme: dark)");
  const show = () => {
    root.dataset.theme = stored() ?? (systemDark.matches ? "dark" : "light");
    dispatchEvent(new Event("themechange"));
  };
  show();
  systemDark.addEventListener("change", show);
  addEventListener("DOMContentLoaded", () => {
    const button = document.getElementById("theme");
    const name = () => {
      const other = root.dataset.theme === "dark" ? "light" : "dark";
      button.textContent = other === "dark" ? "Dark" : "Light";
      button.setAttribute("aria-label", `Switch to the ${other} theme`);
    };
    name();
    addEventListener("themechange", name);
    button.addEventListener("click", () => {
      const other = root.dataset.theme === "dark" ? "light" : "dark";
      try {
        localStorage.setItem("theme", other);
      } catch {
        /* not kept, where the browser keeps nothing */
      }
      root.dataset.theme = other;
      dispatchEvent(new Event("themechange"));
    });
    for (const link of document.querySelectorAll("nav a")) {
      if (link.pathname === location.pathname) link.setAttribute("aria-current", "page");
    }
  });
})();
