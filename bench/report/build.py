"""Puts the results of a run into page.html: one file that opens without a network."""
import base64
import json
import os

PAGE = os.path.join(os.path.dirname(__file__), "page.html")
KINDS = {".png": "png", ".svg": "svg+xml"}


def script(text):
    closed = text.replace("</", "<\\/")
    return f"<script>{closed}</script>\n"


def picture_url(path):
    with open(path, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    return f"data:image/{KINDS[os.path.splitext(path)[1]]};base64,{data}"


def build(report, rows, texts, pictures):
    """Writes `report`. rows: {name: [row]}; texts: {name: Markdown}; pictures: {KIND/MODEL/METHOD: file}."""
    with open(PAGE, encoding="utf-8") as file:
        before, after = file.read().split("@DATA@\n")
    with open(report, "w", encoding="utf-8") as out:
        out.write(before)
        out.write(script(f"Object.assign(window.rows, {json.dumps(rows)})"))
        out.write(script(f"Object.assign(window.texts, {json.dumps(texts)})"))
        for name, path in pictures.items():
            out.write(script(f"window.pictures[{json.dumps(name)}] = {json.dumps(picture_url(path))}"))
        out.write(after)
