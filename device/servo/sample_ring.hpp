/// \file How samples leave the servo's thread: one ring, one writer, one reader, no lock.
#pragma once

#include "device/servo/servo.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace touchtrial::device {

/// A ring of a fixed capacity between two threads. All its memory is taken, and touched, when it
/// is made. Neither side ever waits for the other.
class SampleRing {
 public:
  /// \param capacity  samples that it holds, >= 1; 56 bytes each
  /// \throws std::invalid_argument if capacity is 0
  explicit SampleRing(std::size_t capacity);
  ~SampleRing();
  SampleRing(const SampleRing&) = delete;
  SampleRing& operator=(const SampleRing&) = delete;

  [[nodiscard]] std::size_t capacity() const noexcept;

  /// Servo thread. \return false if the ring is full: the sample is lost
  [[nodiscard]] bool push(const ServoSample& sample) noexcept;

  /// \name Reader's thread
  ///@{
  /// Takes the oldest samples out. \return how many; they are the first ones of `into`
  [[nodiscard]] std::size_t pop(std::span<ServoSample> into) noexcept;
  /// Samples that wait; more may have come since.
  [[nodiscard]] std::size_t waiting() const noexcept;
  ///@}

 private:
  struct Queue;
  std::unique_ptr<Queue> queue_;
};

/// Puts the servo's samples into a ring and counts those for which there was no room.
class RingSink final : public SampleSink {
 public:
  /// \param ring  must outlive this
  explicit RingSink(SampleRing& ring) noexcept : ring_(ring) {}

  void record(const ServoSample& sample) noexcept override {
    if (!ring_.push(sample)) dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  /// Any thread.
  [[nodiscard]] std::int64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  SampleRing& ring_;
  std::atomic<std::int64_t> dropped_{0};
};

}  // namespace touchtrial::device
