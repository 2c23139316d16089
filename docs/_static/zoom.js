// A figure fills the window while it is looked at: by a click, or Enter where it has the focus; any key or click ends it.
document.addEventListener("DOMContentLoaded", () => {
  const dialog = document.createElement("dialog");
  dialog.className = "zoom";
  dialog.setAttribute("aria-label", "Figure, enlarged");
  document.body.append(dialog);
  dialog.addEventListener("click", () => dialog.close());
  dialog.addEventListener("keydown", () => dialog.close());
  for (const picture of document.querySelectorAll("article img")) {
    if (picture.closest("a")) continue;
    const show = () => {
      dialog.replaceChildren(picture.cloneNode());
      dialog.showModal();
    };
    picture.tabIndex = 0;
    picture.setAttribute("role", "button");
    picture.classList.add("zooms");
    picture.addEventListener("click", show);
    picture.addEventListener("keydown", (event) => {
      if (event.key === "Enter") show();
    });
  }
});
