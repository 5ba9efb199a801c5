/// \file The ring that passes samples from the servo's thread: one writer, one reader, no lock.
#pragma once

#include "device/servo/servo.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace touchtrial::device {

/// A ring of a fixed capacity between two threads. The constructor allocates and prefaults all its
/// memory. Neither side ever blocks the other.
class SampleRing {
 public:
  /// \param capacity  in samples, >= 1; 56 bytes each
  /// \throws std::invalid_argument if capacity is 0
  explicit SampleRing(std::size_t capacity);
  ~SampleRing();
  SampleRing(const SampleRing&) = delete;
  SampleRing& operator=(const SampleRing&) = delete;

  [[nodiscard]] std::size_t capacity() const noexcept;

  /// Call it on the servo thread.
  /// \return false if the ring is full: the sample is lost
  [[nodiscard]] bool push(const ServoSample& sample) noexcept;

  /// \name Reader's thread
  /// @{ Moves the oldest samples to the front of `target`.
  /// \return the number of moved samples
  [[nodiscard]] std::size_t pop(std::span<ServoSample> target) noexcept;
  /// \return the number of unread samples, a lower bound for the reader
  [[nodiscard]] std::size_t size() const noexcept;
  ///@}

 private:
  struct Queue;
  std::unique_ptr<Queue> queue_;
};

/// Puts the servo's samples into a ring and counts those that did not fit.
class RingSink final : public SampleSink {
 public:
  /// \param ring  must outlive this
  explicit RingSink(SampleRing& ring) noexcept : ring_(ring) {}

  void record(const ServoSample& sample) noexcept override {
    if (!ring_.push(sample)) dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  /// May be called from any thread.
  [[nodiscard]] std::int64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  SampleRing& ring_;
  std::atomic<std::int64_t> dropped_{0};
};

}  // namespace touchtrial::device
