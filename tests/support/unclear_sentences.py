#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lists sentences of comments, documents and messages whose words often stop a reader, as file:line: sentence.

    tests/support/unclear_sentences.py [PATH...]      # all files in git below the paths; default: the whole checkout

The list is read by a person and is no gate: many of its sentences are clear. A sentence without a verb is not found.
"""
import re
import subprocess
import sys
from pathlib import Path

# A sentence of a comment or document that begins with one of these often lacks its noun.
BEGINNINGS = re.compile(
    r"(That|Those|It|Its|They|These|What|Where|Whose|Who|Of|None|Nobody|Nothing|Such|So|Nor|The others?|The rest|The same"
    r"|This (is|are|was|has|holds|gives|says)|One (of|that|who|whose)|Both|Each of)\b"
)
# Private terms, in sentences and in messages.
PHRASES = re.compile(
    r"\b((is|are|be|was|were|been) said|sa(y|ys|id) so|by the clock|st(and|ands|ood) on|beside|what is there|those that"
    r"|those of|the way gone|what (it|they|each) (is|are|has|have|says?)|that much|as (it|they) (is|are|was|were)\b)"
    r"|, and that\b",
    re.IGNORECASE,
)

LINE_COMMENT = {".h": "//", ".cpp": "//", ".cu": "//", ".py": "#", ".sh": "#", ".cmake": "#", ".toml": "#", ".gp": "#"}
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|cf|vs|et al|etc|Fig|No|pp?)\.$")


def kind_of(path, first_line):
    """The mark that starts a comment, "md" for a document, None for a file without prose."""
    if path.suffix == ".md":
        return "md"
    if path.name in ("CMakeLists.txt", "allowed_skips") or first_line.startswith("#!"):
        return "#"
    return LINE_COMMENT.get(path.suffix)


def prose_of(lines, mark):
    """Yields the prose of a file as lists of (line number, text); each list is one comment or one paragraph."""
    block, in_code = [], False
    for number, line in enumerate(lines, 1):
        if mark == "md":
            in_code ^= line.lstrip().startswith("```")
            text = None if in_code or line.startswith("    ") else line.strip(" |#-*")
            ends, alone = not text, line.startswith(("|", "#"))
        else:
            found = re.match(r"(?P<code>(?:[^\"/#]|\"(?:[^\"\\]|\\.)*\"|/(?!/)|#(?!\s))*?)" + mark + r"[/!]?<?\s(?P<text>.*)", line)
            text = found["text"].strip() if found else None
            alone = bool(found and found["code"].strip())  # a comment behind code is one of its own
            text = None if text and text.startswith("SPDX") else text
            ends = not text or text.startswith(("@", "- "))
            if text and text.startswith("@"):
                text = re.sub(r"^@(param(\[\w+\])?\s+\w+|\w+)\s*", "", text)
        if (ends or alone) and block:
            yield block
            block = []
        if text:
            block.append((number, text))
        if alone and block:
            yield block
            block = []
    if block:
        yield block


def sentences_of(block):
    """Yields (line number, sentence) of one comment or paragraph."""
    words = [(number, word) for number, text in block for word in text.split()]
    sentence, begin = [], 0
    for number, word in words:
        begin = begin if sentence else number
        sentence.append(word)
        text = " ".join(sentence)
        if re.search(r"[.:;?!][)\"*`]*$", word) and not word.endswith((":", ";")) and not ABBREVIATION.search(text):
            yield begin, text
            sentence = []
    if sentence:
        yield begin, " ".join(sentence)


def findings(path):
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (UnicodeDecodeError, OSError):
        return
    mark = kind_of(path, lines[0] if lines else "")
    if not mark:
        return
    for block in prose_of(lines, mark):
        for number, sentence in sentences_of(block):
            if BEGINNINGS.match(sentence) or PHRASES.search(sentence):
                yield number, sentence
    if mark == "//":
        for number, line in enumerate(lines, 1):
            if not line.lstrip().startswith(("//", "#include")):
                for literal in LITERAL.findall(line):
                    if PHRASES.search(literal):
                        yield number, f'"{literal}"'


def main():
    root = subprocess.run(["git", "rev-parse", "--show-toplevel"], check=True, capture_output=True, text=True).stdout.strip()
    command = ["git", "ls-files", "-z", "--full-name"] + (sys.argv[1:] or [root])
    names = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\0")
    for name in sorted((n for n in names if n), key=lambda n: (str(Path(n).parent), n)):
        for number, sentence in sorted(findings(Path(root) / name)):
            print(f"{name}:{number}: {sentence}")


if __name__ == "__main__":
    main()
