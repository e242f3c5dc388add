//! Which kernels are the same machine code, though their sources differ: a compiler schedules as it likes, and much
//! of what a source orders is lost on it.
//!
//! A kernel's code is that of its exported function and of all functions that it calls, in the order of their first
//! calls, as it stands in the object file before it is linked. There every address that is not known yet is a
//! relocation; in its place the code has what the relocation is to: the function's number, the name of something
//! outside, or what the constant is. So nothing of a kernel's place in its library is left.

use std::collections::HashMap;

use object::{
    File, Object, ObjectSection, ObjectSymbol, RelocationTarget, SectionIndex, SectionKind,
    SymbolIndex, SymbolKind,
};

/// Bytes that a constant has at most: those of a vector of AVX-512.
const LARGEST_CONSTANT: usize = 64;

/// The functions of an object file.
pub(crate) struct Functions<'a> {
    file: File<'a>,
    by_name: HashMap<&'a str, SymbolIndex>,
    /// By section and address.
    by_place: HashMap<(SectionIndex, u64), SymbolIndex>,
}

impl<'a> Functions<'a> {
    /// Reads an object file; none if it is none.
    pub fn read(bytes: &'a [u8]) -> Option<Functions<'a>> {
        let file = File::parse(bytes).ok()?;
        let mut by_name = HashMap::new();
        let mut by_place = HashMap::new();
        for symbol in file.symbols() {
            let (SymbolKind::Text, Some(section)) = (symbol.kind(), symbol.section_index()) else {
                continue;
            };
            by_place.insert((section, symbol.address()), symbol.index());
            if let Ok(name) = symbol.name() {
                by_name.insert(name, symbol.index());
            }
        }
        Some(Functions {
            file,
            by_name,
            by_place,
        })
    }

    /// The first 16 digits of the BLAKE3 hash of a function's code; none if there is no such function.
    pub fn hash(&self, function: &str) -> Option<String> {
        let mut called = vec![*self.by_name.get(function)?];
        let mut hasher = blake3::Hasher::new();
        let mut next = 0;
        while let Some(&function) = called.get(next) {
            next += 1;
            self.add(function, &mut called, &mut hasher)?;
            hasher.update(b"end");
        }
        Some(hasher.finalize().to_hex()[..16].to_owned())
    }

    /// Adds the code of one function.
    fn add(
        &self,
        function: SymbolIndex,
        called: &mut Vec<SymbolIndex>,
        hasher: &mut blake3::Hasher,
    ) -> Option<()> {
        let symbol = self.file.symbol_by_index(function).ok()?;
        let section = self.file.section_by_index(symbol.section_index()?).ok()?;
        let data = section.data().ok()?;
        let begin = symbol.address();
        let end = begin + symbol.size();
        let mut at = usize::try_from(begin).ok()?;
        let mut relocations: Vec<_> = section
            .relocations()
            .filter(|(offset, _)| (begin..end).contains(offset))
            .collect();
        relocations.sort_by_key(|(offset, _)| *offset);
        for (offset, relocation) in relocations {
            let offset = usize::try_from(offset).ok()?;
            hasher.update(data.get(at..offset)?);
            let addend = relocation.addend();
            match relocation.target() {
                RelocationTarget::Symbol(target) => {
                    self.add_target(target, addend, called, hasher)?;
                }
                RelocationTarget::Section(target) => {
                    self.add_constant(target, addend, hasher)?;
                }
                _ => return None,
            }
            at = offset + usize::from(relocation.size() / 8).max(4);
        }
        hasher.update(data.get(at..usize::try_from(end).ok()?)?);
        Some(())
    }

    /// Adds what a relocation is to.
    fn add_target(
        &self,
        target: SymbolIndex,
        addend: i64,
        called: &mut Vec<SymbolIndex>,
        hasher: &mut blake3::Hasher,
    ) -> Option<()> {
        let symbol = self.file.symbol_by_index(target).ok()?;
        let Some(section) = symbol.section_index() else {
            hasher.update(symbol.name().ok()?.as_bytes());
            return Some(());
        };
        // The address is told from behind the four bytes that it is told in.
        let place = symbol.address().checked_add_signed(addend + 4)?;
        let Some(&function) = self.by_place.get(&(section, place)) else {
            return self.add_constant(section, symbol.address() as i64 + addend, hasher);
        };
        let number = called.iter().position(|known| *known == function);
        let number = number.unwrap_or_else(|| {
            called.push(function);
            called.len() - 1
        });
        hasher.update(&number.to_le_bytes());
        Some(())
    }

    /// Adds what is in a section, `addend` from its beginning and behind the four bytes of the address.
    fn add_constant(
        &self,
        section: SectionIndex,
        addend: i64,
        hasher: &mut blake3::Hasher,
    ) -> Option<()> {
        let section = self.file.section_by_index(section).ok()?;
        if section.kind() == SectionKind::Text {
            return None;
        }
        let data = section.data().ok()?;
        let begin = usize::try_from(addend + 4).ok()?;
        // Sections of constants that may be merged have constants of one size; their alignment is that.
        let size = usize::try_from(section.align())
            .ok()?
            .clamp(4, LARGEST_CONSTANT);
        hasher.update(data.get(begin..(begin + size).min(data.len()))?);
        Some(())
    }
}
