//! The interpreter's state as far as it is known without running a program (OpenType 1.9, "TrueType instruction set").

use std::collections::BTreeSet;

use read_fonts::tables::glyf::bytecode::Opcode;

use super::cells::Cell;

/// What happens next depends on what is not known.
pub(super) struct Unknown;

/// The state between two instructions.
#[derive(Clone)]
pub(super) struct State {
    /// The stack; a value is `None` if it is computed.
    pub(super) stack: Vec<Option<i32>>,
    /// The cells that the program has written in any case.
    pub(super) written: BTreeSet<Cell>,
    /// How many points the next instruction takes that takes several (`SLOOP`).
    repeats: i32,
}

impl Default for State {
    fn default() -> Self {
        Self { stack: Vec::new(), written: BTreeSet::new(), repeats: 1 }
    }
}

impl State {
    pub(super) fn pop(&mut self) -> Result<Option<i32>, Unknown> {
        self.stack.pop().ok_or(Unknown)
    }

    pub(super) fn pop_constant(&mut self) -> Result<i32, Unknown> {
        self.pop()?.ok_or(Unknown)
    }

    /// Takes values from the stack and leaves computed ones there.
    pub(super) fn replace(&mut self, taken: usize, left: usize) -> Result<(), Unknown> {
        let rest = self.stack.len().checked_sub(taken).ok_or(Unknown)?;
        self.stack.truncate(rest);
        self.stack.resize(rest + left, None);
        Ok(())
    }

    /// What is known after either of two branches.
    pub(super) fn merge(&mut self, other: &Self) -> Result<(), Unknown> {
        if self.stack.len() != other.stack.len() || self.repeats != other.repeats {
            return Err(Unknown);
        }
        for (value, also) in self.stack.iter_mut().zip(&other.stack) {
            if value != also {
                *value = None;
            }
        }
        self.written.retain(|cell| other.written.contains(cell));
        Ok(())
    }

    /// An instruction that only moves values on the stack.
    pub(super) fn shuffle(&mut self, opcode: Opcode) -> Result<(), Unknown> {
        match opcode {
            Opcode::DUP => {
                let top = self.pop()?;
                self.stack.extend([top, top]);
            }
            Opcode::POP => drop(self.pop()?),
            Opcode::CLEAR => self.stack.clear(),
            Opcode::SWAP => {
                let (top, below) = (self.pop()?, self.pop()?);
                self.stack.extend([top, below]);
            }
            Opcode::DEPTH => self.stack.push(i32::try_from(self.stack.len()).ok()),
            Opcode::CINDEX => {
                let at = self.pop_place()?;
                self.stack.push(self.stack[at]);
            }
            Opcode::MINDEX => {
                let at = self.pop_place()?;
                let value = self.stack.remove(at);
                self.stack.push(value);
            }
            Opcode::ROLL => {
                let at = self.stack.len().checked_sub(3).ok_or(Unknown)?;
                let value = self.stack.remove(at);
                self.stack.push(value);
            }
            _ => return Err(Unknown),
        }
        Ok(())
    }

    /// The place in the stack that the value on top counts from there, from 1.
    fn pop_place(&mut self) -> Result<usize, Unknown> {
        let from_top = self.pop_constant()?;
        let from_top = usize::try_from(from_top).ok().filter(|from_top| *from_top > 0).ok_or(Unknown)?;
        self.stack.len().checked_sub(from_top).ok_or(Unknown)
    }

    /// Any other instruction: takes its arguments from the stack and leaves its results there.
    pub(super) fn take(&mut self, opcode: Opcode) -> Result<(), Unknown> {
        let (taken, left) = match opcode as u8 {
            // SVTCA to SFVTCA, SFVTPV, RTG, RTHG, IUP, RTDG, FLIPON, FLIPOFF, ROFF, RUTG, RDTG
            0x00..=0x05 | 0x0E | 0x18..=0x19 | 0x30..=0x31 | 0x3D | 0x4D..=0x4E | 0x7A | 0x7C..=0x7D => {
                (0, 0)
            }
            // GPV, GFV
            0x0C..=0x0D => (0, 2),
            // MPPEM, MPS
            0x4B..=0x4C => (0, 1),
            // SRP, SZP, SMD, SCVTCI, SSWCI, SSW, UTP, MDAP, SHC, SHZ, DEBUG, SDB, SDS, SROUND, S45ROUND, SANGW, AA, SCANCTRL,
            // SCANTYPE, MDRP
            0x10..=0x16 | 0x1A | 0x1D..=0x1F | 0x29 | 0x2E..=0x2F | 0x34..=0x37 | 0x4F | 0x5E..=0x5F => {
                (1, 0)
            }
            0x76..=0x77 | 0x7E..=0x7F | 0x85 | 0x8D | 0xC0..=0xDF => (1, 0),
            // GC, ODD, EVEN, NOT, ABS to NROUND, GETINFO
            0x46..=0x47 | 0x56..=0x57 | 0x5C | 0x64..=0x6F | 0x88 => (1, 1),
            // SPVTL to SFVFS, ALIGNPTS, MSIRP, SCFS, FLIPRGON, FLIPRGOFF, SDPVTL, INSTCTRL
            0x06..=0x0B | 0x27 | 0x3A..=0x3B | 0x48 | 0x81..=0x82 | 0x86..=0x87 | 0x8E => (2, 0),
            // MD, LT to NEQ, AND, OR, ADD, SUB, MUL, MAX, MIN
            0x49..=0x4A | 0x50..=0x55 | 0x5A..=0x5B | 0x60..=0x61 | 0x63 | 0x8B..=0x8C => (2, 1),
            // ISECT
            0x0F => (5, 0),
            // SLOOP
            0x17 => {
                // No number of points, until it is known.
                self.repeats = -1;
                self.repeats = self.pop_constant()?;
                (0, 0)
            }
            // SHP, IP, ALIGNRP, FLIPPT; SHPIX has a distance as well.
            0x32..=0x33 | 0x39 | 0x3C | 0x80 => (self.repeated()?, 0),
            0x38 => (self.repeated()?.saturating_add(1), 0),
            // DELTAP
            0x5D | 0x71..=0x72 => {
                (usize::try_from(self.pop_constant()?).map_err(|_| Unknown)?.saturating_mul(2), 0)
            }
            // Jumps, definitions and what the specification does not have.
            _ => return Err(Unknown),
        };
        self.replace(taken, left)
    }

    fn repeated(&mut self) -> Result<usize, Unknown> {
        usize::try_from(std::mem::replace(&mut self.repeats, 1)).map_err(|_| Unknown)
    }
}
