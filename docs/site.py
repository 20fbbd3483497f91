"""Builds the guide as a static site with search, target/site/index.html, which works from disk and requests nothing from elsewhere.

    python3 -m venv target/site-venv && target/site-venv/bin/pip install -r docs/site-requirements.txt
    target/site-venv/bin/python docs/site.py

Pages: those of docs/SUMMARY.md in its order, README.md, ARCHITECTURE.md, CONTRIBUTING.md, CHANGELOG.md, and every page that one of these links to.
Other files that pages link to become pages of their text. Exit code 1, with file and line, if a link, an anchor, an equation or a language is wrong.
"""
import base64, html, io, json, os, re, shutil, string, sys, time, unicodedata
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import unquote

from fontTools import subset
from markdown_it import MarkdownIt
from markdown_it.token import Token
from math_core import LatexError, LatexToMathML
from mdit_py_plugins.dollarmath import dollarmath_plugin
from pygments import formatters, highlight, lexers

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "target/site"
FURTHER = ["ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"]
faults, formulas, pictures, equations = [], [], set(), {}
latex = LatexToMathML(fancy_error=False)
read = lambda path: (ROOT / path).read_text(encoding="utf-8")
fault = lambda file, line, text: faults.append(f"{file}:{line}: {text}")
relative = lambda target, page: os.path.relpath(target, os.path.dirname(page) or ".").replace(os.sep, "/")
# Path in the site of the page of a file.
address = lambda path: re.sub(r"(^|/)README\.html$", r"\1index.html", re.sub(r"\.(md|ipynb)$", "", path) + ".html")
without_tags = lambda text: html.unescape(re.sub("<[^>]*>", "", text)).replace("\u2061", " ")


def slug(heading):
    """Anchor of a heading, as GitHub and tests/doc_check.py have it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip()).lower()
    return "".join(c for c in text if c.isalnum() or c in " -_").replace(" ", "-")


def plain(tokens):
    """Text for the index; letters of formulas are plain ones."""
    math = lambda t: unicodedata.normalize("NFKC", without_tags(t.content)) if t.type == "math_inline" else t.content
    return "".join(" " if t.type.endswith("break") else math(t) for t in tokens if t.type != "html_inline")


def mathml(text, page, line, display):
    try:
        formulas.append(latex.convert_with_local_state(re.sub(r"\\\\\[[^\]]*\]", r"\\\\", text), displaystyle=display))
    except LatexError as error:
        return fault(page, line, f"equation {text.strip()}: {error}") or ""
    return formulas[-1]


def at_gaps(text):
    """Parts of an equation between the \\qquad outside of its groups: they may stand below each other."""
    depth, begin = 0, 0
    for part in re.finditer(r"\\(begin|left|end|right|qquad)(?![A-Za-z])|\\.|[{}]", text, re.S):
        depth += {"begin": 1, "left": 1, "end": -1, "right": -1}.get(part[1], 0) + {"{": 1, "}": -1}.get(part[0], 0)
        if part[1] == "qquad" and depth == 0:
            yield text[begin : part.start()]
            begin = part.end()
    yield text[begin:]


def equation(text, page, line):
    parts = "".join(f"<span>{mathml(p, page, line, True)}</span>" for p in at_gaps(re.sub(r"\\tag\{.*?\}", "", text)))
    for number in re.findall(r"\\tag\{(.*?)\}", text):
        if number in equations:
            fault(page, line, f"equation ({number}) is also in {equations[number]}")
        equations[number] = page
        return f'<div class="equation" id="eq-{number}"><div class="parts">{parts}</div><a class="tag" href="#eq-{number}">({number})</a></div>\n'
    return f'<div class="equation"><div class="parts">{parts}</div></div>\n'


def source(path):
    """Markdown of a page, of a notebook, or of another file as a block of code."""
    text = read(path)
    if path.endswith(".ipynb"):
        cells = [(c["cell_type"], "".join(c["source"])) for c in json.loads(text)["cells"]]
        return "\n\n".join(s if kind == "markdown" else f"```python\n{s}\n```" for kind, s in cells)
    if path.endswith(".md"):
        return text
    lexer = lexers.YamlLexer if path.endswith(".cff") else lexers.find_lexer_class_for_filename(path, text) or lexers.TextLexer
    return f"# {os.path.basename(path)}\n\n`````{lexer.aliases[0]}\n{text}\n`````\n"


class Page:
    def __init__(self, path, label=None, part=None, depth=0):
        self.path, self.part, self.depth, self.href = path, part, depth, address(path)
        # Sections for the index: anchor, heading, texts; links: file, anchor, as written, line.
        self.sections, self.contents, self.links = [["", "", []]], [], []
        self.tokens = md.parse(source(path))
        line, slugs = 1, []
        for place, token in enumerate(self.tokens):
            line = token.map[0] + 1 if token.map else line
            if token.type == "math_block":
                token.content = equation(token.content, path, line)
            elif token.type in ("fence", "code_block"):
                token.content = self.code(token, line)
            elif token.type == "inline":
                self.inline(token.children, line)
                if self.tokens[place - 1].type == "heading_open":
                    slugs.append(slug(token.content))
                    self.heading(self.tokens[place - 1], token.children, slugs[-1] + (f"-{slugs.count(slugs[-1]) - 1}" if slugs[-1] in slugs[:-1] else ""))
                else:
                    self.sections[-1][2].append(plain(token.children))
        self.anchors = {s[0] for s in self.sections} | {f"eq-{n}" for n, p in equations.items() if p == path}
        self.label = label or self.sections[:2][-1][1] or path

    def heading(self, opening, tokens, anchor):
        opening.attrs["id"] = anchor
        self.sections.append([anchor, plain(tokens), []])
        if opening.tag in ("h2", "h3"):
            shown = md.renderer.renderInline([t for t in tokens if t.type not in ("link_open", "link_close")], md.options, {})
            self.contents.append(f'<li class="{opening.tag}"><a href="#{anchor}">{shown}</a></li>')
        tokens.append(Token("html_inline", "", 0, content=f' <a class="anchor" href="#{anchor}" aria-label="Link to this heading">#</a>'))

    def code(self, token, line):
        self.sections[-1][2].append(token.content)
        try:
            lexer = lexers.get_lexer_by_name(token.info.strip() or "text", stripnl=False)
        except ValueError:
            fault(self.path, line, f"{token.info}: no such language")
            lexer = lexers.TextLexer()
        return f'<div class="code"><pre tabindex="0"><code>{highlight(token.content, lexer, formatters.HtmlFormatter(nowrap=True))}</code></pre></div>\n'

    def inline(self, tokens, line):
        for token in tokens:
            if token.type.endswith("break"):
                line += 1
            elif token.type == "text" and "$" in token.content:
                fault(self.path, line, f"$ that is no equation: {token.content}")
            elif token.type == "math_inline":
                token.content = mathml(token.content, self.path, line, False)
            elif token.type == "link_open":
                token.attrs["href"] = self.link(token.attrs["href"], line)
            elif token.type == "image":
                token.attrs |= {"src": self.link(token.attrs["src"], line), "loading": "lazy"}
                self.inline(token.children, line)

    def link(self, target, line):
        if re.match(r"[a-z]+:", target):
            return target
        name, _, anchor = unquote(target).partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(self.path), name)) if name else self.path
        path = os.path.join(path, "README.md") if (ROOT / path).is_dir() else path
        if path.startswith("..") or not (ROOT / path).is_file():
            fault(self.path, line, f"{target}: no such page or file")
        elif path.endswith((".png", ".jpg", ".svg")):
            pictures.add(path)
        else:
            self.links.append((path, anchor, target, line))
            return (relative(address(path), self.href) if name else "") + (f"#{anchor}" if anchor else "")
        return target


def text(tokens, place, options, env):
    """Text; in the theory manual, numbers of equations lead to them."""
    made = html.escape(tokens[place].content, quote=False)
    if not env.get("page", "").startswith("docs/theory/") or place and tokens[place - 1].type == "link_open":
        return made
    link = lambda m: f'<a href="{relative(address(equations[m[1]]), env["page"])}#eq-{m[1]}">{m[0]}</a>' if m[1] in equations else m[0]
    return re.sub(r"\((\d+\.\d+)\)", link, made)


md = MarkdownIt("commonmark").enable(["table", "strikethrough"]).use(dollarmath_plugin, allow_labels=False, allow_space=False, allow_digits=False)
md.renderer.rules |= {kind: lambda tokens, place, *_: tokens[place].content for kind in ("fence", "code_block", "math_inline", "math_block")}
md.renderer.rules |= {"text": text, "table_open": lambda *_: '<div class="table" tabindex="0"><table>\n', "table_close": lambda *_: "</table></div>\n"}


def whole_site():
    """Pages by path: those of docs/SUMMARY.md, then those that they link to."""
    part, pages = "", {}
    for number, line in enumerate(read("docs/SUMMARY.md").splitlines(), 1):
        if heading := re.match(r"# (.*)", line):
            part = heading[1] if number > 1 else ""
        elif entry := re.match(r"(\s*)(?:[-*] )?\[(.*)\]\((.*)\)\s*$", line):
            path = os.path.normpath(os.path.join("docs", entry[3]))
            if path in pages or not (ROOT / path).is_file():
                fault("docs/SUMMARY.md", number, f"{entry[3]}: " + ("listed twice" if path in pages else "no such page"))
            else:
                pages[path] = Page(path, entry[2], part, len(entry[1]) // 2)
    pages = {"README.md": pages.get("README.md") or Page("README.md", part="")} | pages
    further, waiting = {}, FURTHER + [link[0] for page in pages.values() for link in page.links]
    while waiting:
        path = waiting.pop(0)
        if path not in pages and path not in further:
            further[path] = Page(path, part="Further pages" if path.endswith((".md", ".ipynb")) else None)
            waiting += [link[0] for link in further[path].links]
    pages |= dict(sorted(further.items(), key=lambda item: (item[0] not in FURTHER, item[0])))
    for page, (path, anchor, target, line) in [(page, link) for page in pages.values() for link in page.links]:
        if anchor and anchor not in pages[path].anchors:
            fault(page.path, line, f"{target}: no such heading")
    return list(pages.values())


def write(page, listed):
    part, sidebar, beside = None, "", ["<span></span>"] * 2
    for k, other in enumerate(listed):
        if other.part != part:
            part, sidebar = other.part, sidebar + ("</ul>" if sidebar else "") + (f"<h2>{html.escape(other.part)}</h2>" if other.part else "") + "<ul>"
        link, label = relative(other.href, page.href), html.escape(other.label)
        sidebar += f'<li class="depth{other.depth}"><a href="{link}"' + (' aria-current="page"' if other is page else "") + f">{label}</a></li>"
        for side, (step, name) in enumerate(((1, "Previous"), (-1, "Next"))):
            if 0 <= k + step < len(listed) and listed[k + step] is page:
                beside[side] = f'<a rel="{name[:4].lower()}" href="{link}"><small>{name}</small>{label}</a>'
    contents = f'<details class="contents"><summary>On this page</summary><ul>{"".join(page.contents)}</ul></details>' if len(page.contents) > 1 else ""
    body = md.renderer.render(page.tokens, md.options, {"page": page.path})
    root, title = relative(".", page.href), "trackbed" if page.label == "trackbed" else f"{html.escape(page.label)} · trackbed"
    filled = string.Template(read("docs/site.html")).substitute(
        root=root, title=title, sidebar=sidebar + "</ul>", contents=contents, body=body, previous=beside[0], next=beside[1])
    (OUT / page.href).parent.mkdir(parents=True, exist_ok=True)
    (OUT / page.href).write_text(filled, encoding="utf-8")


def math_font():
    """Style sheet with the glyphs of STIX Two Math that the formulas need."""
    font = subset.load_font(str(Path(find_spec("ziamath").origin).parent / "fonts/STIXTwoMath-Regular.ttf"), subset.Options())
    subsetter = subset.Subsetter(subset.Options(layout_features=["*"], drop_tables=["DSIG"]))
    # Browsers draw roots themselves, and names of one letter in italics, of Latin and Greek.
    subsetter.populate(unicodes=[*map(ord, without_tags("".join(formulas))), ord("√"), 0x210E, *range(0x20, 0x7F), *range(0x1D434, 0x1D468), *range(0x1D6E2, 0x1D71C)])
    subsetter.subset(font)
    font.flavor, file = "woff2", io.BytesIO()
    font.save(file)
    data = base64.b64encode(file.getvalue()).decode()
    return f'/* STIX Two Math, SIL Open Font License 1.1 */ @font-face {{ font-family: "Site Math"; src: url(data:font/woff2;base64,{data}); }}\n'


def main():
    begun, pages = time.monotonic(), whole_site()
    listed = [p for p in pages if p.part is not None]
    shutil.rmtree(OUT, ignore_errors=True)
    for page in pages:
        write(page, listed)
    for file, place in [(p, p) for p in pictures] + [("docs/site.js", "site.js")]:
        (OUT / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / file, OUT / place)
    light, dark = (formatters.HtmlFormatter(style=s).get_style_defs(".code") for s in ("default", "github-dark"))
    sections = [[k, anchor, head, " ".join(" ".join(texts).split())] for k, p in enumerate(listed) for anchor, head, texts in p.sections if anchor or texts]
    index = json.dumps({"pages": [[p.href, p.label] for p in listed], "sections": sections}, ensure_ascii=False, separators=(",", ":"))
    (OUT / "site.css").write_text(f"{light}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n{read('docs/site.css')}{math_font()}", encoding="utf-8")
    (OUT / "search-index.js").write_text(f"const INDEX = {index};\n", encoding="utf-8")
    words = sum(bool(re.search("[A-Za-z0-9]", w)) for s in sections for w in f"{s[2]} {s[3]}".split())
    print(*faults, sep="\n", end="\n" if faults else "", file=sys.stderr)
    print(f"{OUT}/index.html: {len(listed)} pages, {len(pages) - len(listed)} files, {len(formulas)} formulas, {len(equations)} numbered equations, "
          f"{words} words indexed, {len(faults)} faults, {time.monotonic() - begun:.1f} s")
    return bool(faults)


sys.exit(main())
