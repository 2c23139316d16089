/** A browser that was started in the C locale names a language, en-US@posix, that no formatter of numbers takes. */

try {
  new Intl.NumberFormat(navigator.language);
} catch {
  Object.defineProperty(navigator, "language", { value: "en" });
}
