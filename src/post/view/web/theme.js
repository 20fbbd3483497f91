// Light or dark controls: by the system, or set for the session.

const KEY = 'trackbed theme';
const dark = matchMedia('(prefers-color-scheme: dark)');

/** Theme of the session; none if not set, or if the browser has no storage for the page. */
function stored() {
  try {
    return sessionStorage.getItem(KEY);
  } catch {
    return null;
  }
}

/** Applies the theme now and after each change, followed by `changed`. */
export function theme(button, changed) {
  const show = () => {
    document.documentElement.dataset.theme = stored() ?? (dark.matches ? 'dark' : 'light');
    changed();
  };
  button.onclick = () => {
    const other = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
    try {
      sessionStorage.setItem(KEY, other);
    } catch {
      // Without storage the theme of the system is kept.
    }
    show();
  };
  dark.addEventListener('change', show);
  show();
}
