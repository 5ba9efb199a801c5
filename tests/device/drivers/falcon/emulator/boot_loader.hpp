/// \file The program in a Falcon that receives its firmware.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace touchtrial::device::falcon {

/// How a boot loader behaves, and misbehaves.
struct BootLoaderOptions {
  std::vector<std::uint8_t> image{};  ///< the only one that runs; empty: any runs
  int unanswered_greetings = 0;       ///< before it answers one
  bool leading_zero = false;          ///< before the answer to a greeting
  int bad_loads = 0;                  ///< how many loads fail before one succeeds
  int bad_block = 0;                  ///< of a bad load: the block, from 0, with a wrong echo
  bool silent_block = false;          ///< that block has no echo instead
};

/// Not thread-safe.
class BootLoader {
 public:
  static constexpr std::size_t kMaxBlock = 62;
  using Bytes = std::vector<std::uint8_t>;

  explicit BootLoader(BootLoaderOptions options) : options_(std::move(options)) {}

  /// Takes bytes while the line is set for a greeting.
  /// \return its answer
  [[nodiscard]] Bytes greet(std::span<const std::uint8_t> bytes);
  /// Takes bytes while the line is set for loading.
  /// \return its answer
  [[nodiscard]] Bytes load(std::span<const std::uint8_t> bytes);
  /// \return whether the loaded bytes are a firmware that runs
  [[nodiscard]] bool can_run() const;

  [[nodiscard]] const Bytes& image() const { return image_; }
  [[nodiscard]] int loads() const { return loads_; }

 private:
  enum class Step { idle, greeted, loading };

  [[nodiscard]] Bytes echo(std::span<const std::uint8_t> block);

  BootLoaderOptions options_;
  Step step_ = Step::idle;
  Bytes image_;
  int greetings_ = 0;
  int loads_ = 0;
  int block_ = 0;
};

}  // namespace touchtrial::device::falcon
