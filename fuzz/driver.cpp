// The entry point of libFuzzer, compiled once for each entry with the entry's name.
#include "fuzz/entries.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  touchtrial::fuzz::TOUCHTRIAL_FUZZ_ENTRY({data, size});
  return 0;
}
