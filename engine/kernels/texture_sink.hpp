/// \file Where the rows of a texture go: its plane, and what else is wanted of it.
#pragma once

#include "engine/extraction.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/force_rows.hpp"
#include "engine/kernels/streamed_row.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace touchtrial::engine {

/// Takes the rows of a texture from top to bottom and makes picture and force of them while they
/// are in the cache. Planes too large for it are written past it, from rows of scratch.
class TextureSink {
 public:
  /// \param result  its planes get the shape height x width, or 0 x 0 if they are not wanted;
  ///   nothing is allocated where they have it already. Must outlive this.
  TextureSink(int height, int width, const WantedPlanes& wanted, Extraction<float>& result);

  /// Where row y is to be written, width samples and no more; the rows before it must have been
  /// finished.
  [[nodiscard]] float* row(int y) noexcept;
  /// What must be moved between row(y) and finish_row(y), by who computes the row.
  [[nodiscard]] std::span<const StreamedRow> waiting() const noexcept {
    return {waiting_.data(), waiting_count_};
  }
  void finish_row(int y);
  /// After the last row.
  void finish();

  /// Instead of all the rows: no texture anywhere.
  void fill_flat();

 private:
  void add_force(int y);
  void wait(const float* from, float* to);

  int height_;
  int width_;
  Extraction<float>& result_;
  bool past_caches_;
  std::optional<ForceRows> force_;             // where there is to be force
  std::optional<AlignedRows<float>> scratch_;  // rows that wait: two of texture, or force x and y
  std::array<StreamedRow, 2> waiting_;
  std::size_t waiting_count_ = 0;
};

}  // namespace touchtrial::engine
