// Windows: open, help, about; what was picked.
import { figure, scaled } from 'colours';

const $ = (id) => document.getElementById(id);

export function dialogs(app) {
  const show = (id) => { $(id).showModal(); };
  $('button-help').onclick = () => show('help');
  $('button-about').onclick = () => show('about');
  $('button-open').onclick = async () => {
    $('open-message').textContent = '';
    show('open');
    if (!app.served) return;
    const folders = await (await fetch('/folders')).json();
    $('open-runs').hidden = folders.length === 0;
    $('open-run').replaceChildren(...folders.map((folder) => new Option(folder || '(this folder)', folder)));
    $('open-run').value = app.state.run;
  };
  document.querySelectorAll('dialog .close').forEach((button) => { button.onclick = () => button.closest('dialog').close(); });
  const attempt = async (act) => {
    const message = $('open-message');
    message.className = '';
    message.textContent = 'Loading file, please wait';
    try {
      await act();
      message.textContent = `${app.state.frames} frame(s) read`;
      $('open').close();
    } catch (error) {
      message.className = 'error';
      message.textContent = error.message;
    }
  };
  $('open-run-button').onclick = () => attempt(() => app.openRun($('open-run').value));
  for (const id of ['open-files', 'open-folder']) {
    $(id).onchange = () => {
      const files = [...$(id).files];
      $(id).value = '';
      if (files.length) attempt(() => app.openFiles(files));
    };
  }
  const stage = $('stage');
  stage.addEventListener('dragover', (event) => event.preventDefault());
  stage.addEventListener('drop', (event) => {
    event.preventDefault();
    show('open');
    attempt(() => app.openFiles([...event.dataTransfer.files]));
  });
}

/** Shows what was picked, as text. */
export function showPicked(picked) {
  const box = $('picked');
  box.hidden = !picked;
  if (!picked) return;
  const rows = picked.data.map(([name, value, plain]) => {
    const row = document.createElement('tr');
    const number = typeof value === 'number';
    const { factor, unit } = number ? scaled(plain, value) : { factor: 1, unit: plain };
    const shown = number && !unit && Number.isInteger(value) ? value : number ? figure(value / factor) : Array.isArray(value) ? value.map((v) => v.toFixed(4)).join(', ') : value;
    for (const text of [name, `${shown}${unit ? ` ${unit}` : ''}`]) {
      const cell = document.createElement('td');
      cell.textContent = text;
      row.append(cell);
    }
    return row;
  });
  $('picked-title').textContent = picked.title;
  $('picked-data').replaceChildren(...rows);
}
