/// \file Where bytes from outside enter the program, one function for each kind. The fuzzers call
/// them with what they make up, a test with the files of fuzz/corpus.
#pragma once

#include "core/bytes.hpp"

#include <array>
#include <string_view>

namespace touchtrial::fuzz {

/// Each reads the bytes as a file of its kind, and either accepts them or catches the refusal.
/// \throws std::logic_error if what was accepted contradicts itself, or a refusal is not one line
/// \throws what the reader throws besides the errors that it documents: a bug
void read_as_image(ByteView bytes);
void read_as_study(ByteView bytes);
void read_as_subject(ByteView bytes);
void read_as_trace(ByteView bytes);
/// What a Falcon sends: bulk transfers, each after a byte that tells its size.
void read_as_falcon(ByteView bytes);

struct Entry {
  std::string_view name;  ///< of the fuzzer, and of its folder in fuzz/corpus
  void (*read)(ByteView bytes);
};

inline constexpr std::array<Entry, 5> kEntries = {{{"image", read_as_image},
                                                   {"study", read_as_study},
                                                   {"subject", read_as_subject},
                                                   {"trace", read_as_trace},
                                                   {"falcon", read_as_falcon}}};

}  // namespace touchtrial::fuzz
