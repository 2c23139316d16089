/** The parts of the page, by name. */

export function part<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no part ${id}`);
  return found as T;
}

export function onClick(id: string, act: () => void): void {
  part(id).addEventListener("click", act);
}

export function onChange(id: string, act: (value: string) => void): void {
  const input = part<HTMLSelectElement | HTMLInputElement>(id);
  input.addEventListener("change", () => act(input.value));
}
