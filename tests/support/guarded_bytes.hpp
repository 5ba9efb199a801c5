/// \file Memory with pages that can be made inaccessible, so that reading them ends the test.
#pragma once

#include "support/catch.hpp"

#include <cstddef>
#include <cstring>
#include <set>
#include <span>

#include <sys/mman.h>
#include <unistd.h>

namespace touchtrial {

inline std::size_t page_size() {
  return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// A copy of bytes on separate pages.
class GuardedBytes {
 public:
  explicit GuardedBytes(std::span<const std::byte> bytes)
      : size_(bytes.size()),
        memory_(
            ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    REQUIRE(memory_ != MAP_FAILED);
    std::memcpy(memory_, bytes.data(), size_);
  }
  ~GuardedBytes() { ::munmap(memory_, size_); }
  GuardedBytes(const GuardedBytes&) = delete;
  GuardedBytes& operator=(const GuardedBytes&) = delete;

  template <typename Number>
  [[nodiscard]] std::span<const Number> as() const {
    return {static_cast<const Number*>(memory_), size_ / sizeof(Number)};
  }
  [[nodiscard]] std::size_t pages() const { return (size_ + page_size() - 1) / page_size(); }

  /// Makes all pages inaccessible except these (from 0).
  void leave_only(const std::set<std::size_t>& pages) {
    REQUIRE(::mprotect(memory_, size_, PROT_NONE) == 0);
    for (const std::size_t page : pages) {
      auto* start = static_cast<std::byte*>(memory_) + page * page_size();
      REQUIRE(::mprotect(start, page_size(), PROT_READ) == 0);
    }
  }

 private:
  std::size_t size_;
  void* memory_;
};

}  // namespace touchtrial
