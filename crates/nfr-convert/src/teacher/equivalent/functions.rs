//! The functions that a font's programs can call: those that `fpgm` defines (OpenType 1.9, "TrueType instruction set", `FDEF`).

use std::collections::HashMap;

use read_fonts::tables::glyf::bytecode::{Opcode, decode_all};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};

/// The bodies of functions by number. A function that is defined twice is not there: which one is meant depends on the size.
#[derive(Default)]
pub(super) struct Functions<'a>(HashMap<i32, Option<&'a [u8]>>);

impl<'a> Functions<'a> {
    pub(super) fn of(font: &FontRef<'a>) -> Self {
        let program = |tag| font.data_for_tag(Tag::new(tag)).map_or(&[][..], |data| data.as_bytes());
        let defines = |code| decode_all(code, 0).map_while(Result::ok).any(|i| i.opcode == Opcode::FDEF);
        if defines(program(b"prep")) {
            return Self::default();
        }
        Self::defined_in(program(b"fpgm"))
    }

    /// Reads definitions whose numbers are pushed, at once or one by one.
    fn defined_in(code: &'a [u8]) -> Self {
        let mut functions = HashMap::new();
        let mut stack = Vec::new();
        let mut open: Option<(Option<i32>, usize)> = None;
        for instruction in decode_all(code, 0).map_while(Result::ok) {
            let after = instruction.pc + 1;
            match instruction.opcode {
                Opcode::FDEF => open = Some((stack.pop(), after)),
                Opcode::ENDF => {
                    if let Some((Some(number), from)) = open.take() {
                        let body = Some(&code[from..instruction.pc]);
                        functions.entry(number).and_modify(|known| *known = None).or_insert(body);
                    }
                }
                _ if open.is_some() => {}
                opcode if opcode.is_push() => stack.extend(instruction.inline_operands.values()),
                // Numbers that are pushed before anything else have an unknown place on the stack.
                _ => stack.clear(),
            }
        }
        Self(functions)
    }

    pub(super) fn get(&self, number: i32) -> Option<&'a [u8]> {
        self.0.get(&number).copied().flatten()
    }
}
