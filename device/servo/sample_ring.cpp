#include "device/servo/sample_ring.hpp"

#include <array>
#include <stdexcept>

#include <boost/lockfree/spsc_queue.hpp>

namespace touchtrial::device {

struct SampleRing::Queue {
  explicit Queue(std::size_t queue_capacity) : capacity(queue_capacity), samples(queue_capacity) {}

  std::size_t capacity;
  boost::lockfree::spsc_queue<ServoSample> samples;
};

SampleRing::SampleRing(std::size_t capacity) {
  if (capacity == 0) throw std::invalid_argument("SampleRing: capacity must be at least 1");
  queue_ = std::make_unique<Queue>(capacity);
  // Prefaults every page, so that the loop has no page faults.
  while (push({})) {
  }
  std::array<ServoSample, 256> batch;
  while (pop(batch) != 0) {
  }
}

SampleRing::~SampleRing() = default;

std::size_t SampleRing::capacity() const noexcept {
  return queue_->capacity;
}

bool SampleRing::push(const ServoSample& sample) noexcept {
  return queue_->samples.push(sample);
}

std::size_t SampleRing::pop(std::span<ServoSample> target) noexcept {
  return queue_->samples.pop(target.data(), target.size());
}

std::size_t SampleRing::size() const noexcept {
  return queue_->samples.read_available();
}

}  // namespace touchtrial::device
