//! Follows a program with a stack of which only the values are known that are pushed as constants. Points, and whatever is
//! computed, are unknown; of an `IF`, both branches are followed. Jumps, and functions whose number is computed, cannot be
//! followed.

use std::collections::BTreeSet;

use read_fonts::tables::glyf::bytecode::{Instruction, Opcode, decode_all};

use super::cells::{Cell, Table};
use super::functions::Functions;
use super::state::{State, Unknown};

/// The most instructions that are followed in one program.
const MAX_STEPS: usize = 20_000;
/// The most calls within calls.
const MAX_CALLS: usize = 32;
/// The most repetitions of a `LOOPCALL`.
const MAX_LOOP: i32 = 256;

/// The sizes of what programs use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    pub(super) control_values: usize,
    pub(super) storage: usize,
    pub(super) stack: usize,
}

/// What a program does that was followed.
#[derive(Default)]
pub(super) struct Followed {
    /// The cells that it may read before it writes them.
    pub(super) reads: BTreeSet<Cell>,
    /// The cells that it may write.
    pub(super) writes: BTreeSet<Cell>,
    /// Those of them that later programs could mean to read. In storage, functions keep what they need until they return.
    pub(super) lasting: BTreeSet<Cell>,
    /// Whether it was followed to its end, so that there are no other cells.
    pub(super) complete: bool,
    /// Whether it does more than write cells: it moves points, sets state or can fail.
    pub(super) does_more: bool,
    /// Whether it leaves values on the stack.
    pub(super) leftover: bool,
}

/// Follows a program.
pub(super) fn follow(code: &[u8], functions: &Functions<'_>, sizes: Sizes) -> Followed {
    let mut follower = Follower {
        functions,
        sizes,
        state: State::default(),
        found: Followed::default(),
        steps: 0,
        calls: 0,
    };
    let complete = follower.run(code).is_ok();
    if !complete {
        // Calls that were not followed to their end.
        follower.calls = 0;
        follower.scan(code);
    }
    let leftover = !follower.state.stack.is_empty();
    let does_more = follower.found.does_more || !complete;
    Followed { complete, leftover, does_more, ..follower.found }
}

/// Whether an instruction only moves values between the stack and the shared tables, and computes.
pub(super) fn only_computes(opcode: Opcode) -> bool {
    let shared = accesses(opcode) != (None, None) && !is_indirect(opcode);
    // What moves values on the stack, comparison, logic, arithmetic and rounding, MAX, MIN, and what the size and the renderer
    // are: MPPEM, MPS, GETINFO.
    let computes = matches!(
        opcode as u8,
        0x20..=0x26 | 0x8A | 0x50..=0x57 | 0x5A..=0x5C | 0x60..=0x6F | 0x8B..=0x8C | 0x4B..=0x4C | 0x88
    );
    opcode.is_push() || shared || computes
}

/// Whether an instruction moves a point to a control value: MIAP, MIRP.
fn is_indirect(opcode: Opcode) -> bool {
    matches!(opcode as u8, 0x3E..=0x3F | 0xE0..)
}

/// The tables that an instruction reads and writes.
fn accesses(opcode: Opcode) -> (Option<Table>, Option<Table>) {
    match opcode as u8 {
        // RCVT, MIAP, MIRP
        0x45 | 0x3E..=0x3F | 0xE0.. => (Some(Table::ControlValues), None),
        // DELTAC
        0x73..=0x75 => (Some(Table::ControlValues), Some(Table::ControlValues)),
        // WCVTP, WCVTF
        0x44 | 0x70 => (None, Some(Table::ControlValues)),
        // RS, WS
        0x43 => (Some(Table::Storage), None),
        0x42 => (None, Some(Table::Storage)),
        _ => (None, None),
    }
}

struct Follower<'a> {
    functions: &'a Functions<'a>,
    sizes: Sizes,
    state: State,
    found: Followed,
    steps: usize,
    calls: usize,
}

/// The state before an `IF`, and that after its first branch, if there is a second one.
struct Branch {
    before: State,
    first: Option<State>,
}

impl Follower<'_> {
    fn run(&mut self, code: &[u8]) -> Result<(), Unknown> {
        let mut branches: Vec<Branch> = Vec::new();
        for instruction in decode_all(code, 0) {
            let instruction = instruction.map_err(|_| Unknown)?;
            self.steps += 1;
            if self.steps > MAX_STEPS || self.state.stack.len() > self.sizes.stack {
                return Err(Unknown);
            }
            match instruction.opcode {
                Opcode::IF => {
                    self.state.pop()?;
                    branches.push(Branch { before: self.state.clone(), first: None });
                }
                Opcode::ELSE => {
                    let branch =
                        branches.last_mut().filter(|branch| branch.first.is_none()).ok_or(Unknown)?;
                    branch.first = Some(std::mem::replace(&mut self.state, branch.before.clone()));
                }
                Opcode::EIF => {
                    let branch = branches.pop().ok_or(Unknown)?;
                    self.state.merge(branch.first.as_ref().unwrap_or(&branch.before))?;
                }
                _ => self.execute(&instruction)?,
            }
        }
        let fits = self.state.stack.len() <= self.sizes.stack;
        if branches.is_empty() && fits { Ok(()) } else { Err(Unknown) }
    }

    /// Notes the accesses of a program's own instructions, wherever they are, with what is known of the stack.
    fn scan(&mut self, code: &[u8]) {
        self.state = State::default();
        for instruction in decode_all(code, 0).map_while(Result::ok) {
            let opcode = instruction.opcode;
            // What has been written may have been in another branch.
            self.state.written.clear();
            let called = matches!(opcode, Opcode::CALL | Opcode::LOOPCALL);
            if called || self.execute(&instruction).is_err() {
                self.state.stack.clear();
                let (reads, writes) = accesses(opcode);
                self.found.reads.extend(reads.map(|table| (table, None)));
                if let Some(table) = writes {
                    self.write((table, None));
                }
            }
        }
    }

    fn execute(&mut self, instruction: &Instruction<'_>) -> Result<(), Unknown> {
        match instruction.opcode {
            Opcode::RCVT => self.read_and_push(Table::ControlValues),
            Opcode::RS => self.read_and_push(Table::Storage),
            Opcode::WCVTP | Opcode::WCVTF => self.pop_and_write(Table::ControlValues),
            Opcode::WS => self.pop_and_write(Table::Storage),
            Opcode::DELTAC1 | Opcode::DELTAC2 | Opcode::DELTAC3 => self.delta_control_values(),
            Opcode::CALL => {
                let number = self.state.pop_constant()?;
                self.call(number, 1)
            }
            Opcode::LOOPCALL => {
                let number = self.state.pop_constant()?;
                let count = self.state.pop_constant()?;
                // What calls remain to a program depends on how many there have been.
                self.found.does_more = true;
                self.call(number, count)
            }
            Opcode::DIV => {
                // A division by zero ends the program.
                self.found.does_more |= matches!(self.state.stack.last(), Some(None | Some(0)));
                self.state.replace(2, 1)
            }
            opcode if opcode.is_push() => {
                self.state.stack.extend(instruction.inline_operands.values().map(Some));
                Ok(())
            }
            opcode if matches!(opcode as u8, 0x20..=0x26 | 0x8A) => self.state.shuffle(opcode),
            opcode => self.other(opcode),
        }
    }

    /// An instruction of which only the number of values matters that it takes from the stack and leaves there.
    fn other(&mut self, opcode: Opcode) -> Result<(), Unknown> {
        self.found.does_more |= !only_computes(opcode);
        if is_indirect(opcode) {
            // The control value's index is on top.
            let index = self.state.pop()?;
            self.read(Table::ControlValues, index);
            return self.state.replace(1, 0);
        }
        self.state.take(opcode)
    }

    fn read_and_push(&mut self, table: Table) -> Result<(), Unknown> {
        let index = self.state.pop()?;
        self.read(table, index);
        self.state.stack.push(None);
        Ok(())
    }

    fn pop_and_write(&mut self, table: Table) -> Result<(), Unknown> {
        self.state.pop()?;
        let index = self.state.pop()?;
        self.check(table, index);
        self.write((table, index));
        self.state.written.extend(index.map(|index| (table, Some(index))));
        Ok(())
    }

    /// `DELTAC` changes a control value at one size.
    fn delta_control_values(&mut self) -> Result<(), Unknown> {
        for _ in 0..self.state.pop_constant()? {
            let index = self.state.pop()?;
            self.state.pop()?;
            self.read(Table::ControlValues, index);
            self.write((Table::ControlValues, index));
        }
        Ok(())
    }

    fn write(&mut self, cell: Cell) {
        self.found.writes.insert(cell);
        if self.calls == 0 || cell.0 == Table::ControlValues {
            self.found.lasting.insert(cell);
        }
    }

    fn read(&mut self, table: Table, index: Option<i32>) {
        self.check(table, index);
        if index.is_none() || !self.state.written.contains(&(table, index)) {
            self.found.reads.insert((table, index));
        }
    }

    /// Notes an access that may be outside of its table, which ends a program in some renderers.
    fn check(&mut self, table: Table, index: Option<i32>) {
        let size = match table {
            Table::ControlValues => self.sizes.control_values,
            Table::Storage => self.sizes.storage,
        };
        let within = index.and_then(|index| usize::try_from(index).ok()).is_some_and(|index| index < size);
        self.found.does_more |= !within;
    }

    fn call(&mut self, number: i32, count: i32) -> Result<(), Unknown> {
        let body = self.functions.get(number).ok_or(Unknown)?;
        if self.calls == MAX_CALLS || count > MAX_LOOP {
            return Err(Unknown);
        }
        self.calls += 1;
        for _ in 0..count {
            self.run(body)?;
        }
        self.calls -= 1;
        Ok(())
    }
}
