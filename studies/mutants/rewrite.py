"""Puts mutants behind a switch: each becomes a branch of the same program, taken when it is on."""

import bisect
import re
from dataclasses import dataclass, field

import tree_sitter_rust
from tree_sitter import Language, Parser

PARSER = Parser(Language(tree_sitter_rust.language()))
VARIABLE = "ASPERITY_MUTANT"
# The module that every switch asks. No mutant has the number 0.
SWITCH = f"""//! Which mutant is on.

use std::sync::OnceLock;

static ON: OnceLock<u32> = OnceLock::new();

/// The number of the mutant that is on, 0 if none is.
#[inline]
pub(crate) fn on() -> u32 {{
    *ON.get_or_init(|| {{
        let number = std::env::var("{VARIABLE}").ok();
        number.and_then(|number| number.parse().ok()).unwrap_or(0)
    }})
}}
"""
ON = "crate::mutant::on()"
MARK = re.compile(rb"/\*\[(\d+)\*/.*?/\*\1\]\*/", re.DOTALL)


class CannotSwitch(Exception):
    """The mutant is no branch of a running program; the text says why."""


@dataclass
class Host:
    """An expression and what mutants make of it: `match on() { 7 => mutated, _ => expression }`."""

    start: int
    end: int
    mutated: dict[int, bytes] = field(default_factory=dict)


class Source:
    """A source file with its mutants."""

    def __init__(self, text):
        self.text = text.encode()
        self.root = PARSER.parse(self.text).root_node
        if self.root.has_error:
            raise SystemExit("tree-sitter cannot parse a source file: update tree-sitter-rust")
        self.lines = text.splitlines(keepends=True)
        self.offsets = [0]
        for line in self.lines:
            self.offsets.append(self.offsets[-1] + len(line.encode()))
        self.hosts = {}
        self.insertions = {}

    def offset(self, position):
        line, column = position
        return self.offsets[line - 1] + len(self.lines[line - 1][: column - 1].encode())

    def add(self, mutant):
        """Puts a mutant behind a switch.

        Raises CannotSwitch where there is nothing to branch at run time.
        """
        start, end = self.offset(mutant.start), self.offset(mutant.end)
        node = self.root.descendant_for_byte_range(start, end)
        refuse_constants(node)
        getattr(self, mutant.genre)(mutant, node, start, end)

    def FnValue(self, mutant, node, start, end):
        if "impl " in mutant.return_type:
            raise CannotSwitch("two values behind one `impl Trait` have two types")
        text = f"if {ON} == {mutant.id} {{ return {mutant.replacement}; }}"
        self.insert(start, mutant.id, text)

    def BinaryOperator(self, mutant, node, start, end):
        host = node.parent
        if host is None or host.type not in ("binary_expression", "compound_assignment_expr"):
            raise CannotSwitch(f"an operator of a {host and host.type}")
        # The mutant is a change of text: another operator may bind in another way, so the whole
        # chain of operators is read anew.
        while host.parent.type == "binary_expression":
            host = host.parent
        self.replace(host, mutant, start, end)

    def UnaryOperator(self, mutant, node, start, end):
        host = node.parent
        if host is None or host.type != "unary_expression":
            raise CannotSwitch(f"an operator of a {host and host.type}")
        self.replace(host, mutant, start, end)

    def StructField(self, mutant, node, start, end):
        while node.type != "struct_expression":
            node = node.parent
        self.replace(node, mutant, start, end)

    def MatchArmGuard(self, mutant, node, start, end):
        self.host(start, end).mutated[mutant.id] = mutant.replacement.encode()

    def MatchArm(self, mutant, node, start, end):
        while node.type != "match_arm":
            node = node.parent
        pattern = node.child_by_field_name("pattern")
        guard = pattern.child_by_field_name("condition")
        if guard is None:
            self.insert(pattern.end_byte, mutant.id, f" if {ON} != {mutant.id}")
        else:
            self.host(guard.start_byte, guard.end_byte).mutated[mutant.id] = b"false"

    def host(self, start, end):
        return self.hosts.setdefault((start, end), Host(start, end))

    def insert(self, at, number, text):
        self.insertions.setdefault(at, []).append(marked(number, text.encode()))

    def replace(self, host, mutant, start, end):
        """What cargo-mutants writes, within the expression `host`."""
        mutated = self.text[host.start_byte : start] + mutant.replacement.encode()
        mutated += self.text[end : host.end_byte]
        self.host(host.start_byte, host.end_byte).mutated[mutant.id] = mutated

    def written(self):
        """The file with all its switches."""
        # Where two begin at the same place, the longer is outside.
        hosts = sorted(self.hosts.values(), key=lambda host: (host.start, -host.end))
        return self.between(0, len(self.text), hosts)

    def between(self, start, end, hosts):
        """The text of [start, end) with the switches of `hosts`, which lie in it."""
        out, at = [], start
        while hosts:
            host = hosts[0]
            behind = bisect.bisect_left(hosts, host.end, key=lambda inner: inner.start)
            out.append(self.plain(at, host.start))
            out.append(f"(match {ON} {{ ".encode())
            for number, mutated in host.mutated.items():
                out.append(marked(number, f"{number} => (".encode() + mutated + b"),"))
            out.append(b" _ => (" + self.between(host.start, host.end, hosts[1:behind]) + b") })")
            at, hosts = host.end, hosts[behind:]
        out.append(self.plain(at, end))
        return b"".join(out)

    def plain(self, start, end):
        """The text of [start, end) with what is inserted into it or behind it: ahead of a host, not in it."""
        out, at = [], start
        for place in sorted(self.insertions):
            if start < place <= end:
                out.append(self.text[at:place])
                out.extend(self.insertions[place])
                at = place
        out.append(self.text[at:end])
        return b"".join(out)


def marked(number, text):
    """Text with marks that tell which mutant an error of the compiler is of."""
    return f"/*[{number}*/".encode() + text + f"/*{number}]*/".encode()


def blamed(written, start, end):
    """The mutant whose text holds the bytes [start, end) of a written file, if one does."""
    for mark in MARK.finditer(written):
        if mark.start() <= start and end <= mark.end():
            return int(mark.group(1))
    return None


def refuse_constants(node):
    """Constants are computed once, by the compiler; what a macro is given is no expression yet."""
    inner = node
    while (outer := inner.parent) is not None:
        kind = outer.type
        if kind in ("const_item", "static_item", "const_block", "array_type", "enum_variant"):
            raise CannotSwitch("a constant")
        if kind == "array_expression" and outer.child_by_field_name("length") == inner:
            raise CannotSwitch("a constant")
        if kind == "token_tree":
            raise CannotSwitch("an argument of a macro")
        if kind == "match_pattern" and outer.child_by_field_name("condition") != inner:
            raise CannotSwitch("a pattern")
        if kind == "function_item":
            modifiers = [child for child in outer.children if child.type == "function_modifiers"]
            if any(b"const" in child.text.split() for child in modifiers):
                raise CannotSwitch("a const fn")
        inner = outer
