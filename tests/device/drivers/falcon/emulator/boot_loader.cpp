#include "device/drivers/falcon/emulator/boot_loader.hpp"

#include <algorithm>
#include <array>

namespace touchtrial::device::falcon {
namespace {

constexpr std::array<std::uint8_t, 3> kGreeting = {0x0A, 0x43, 0x0D};
constexpr std::uint8_t kLoadMark = 0x41;

bool equal(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

BootLoader::Bytes BootLoader::greet(std::span<const std::uint8_t> bytes) {
  step_ = Step::idle;
  if (!equal(bytes, kGreeting)) return {};
  if (greetings_++ < options_.unanswered_greetings) return {};
  step_ = Step::greeted;
  if (options_.leading_zero) return {0x00, 0x0A, 0x44, 0x2C, 0x0D};
  return {0x0A, 0x44, 0x2C, 0x0D};
}

BootLoader::Bytes BootLoader::load(std::span<const std::uint8_t> bytes) {
  if (step_ == Step::idle || bytes.empty()) return {};
  if (step_ == Step::loading) return echo(bytes);
  if (bytes.size() != 1 || bytes[0] != kLoadMark) return {};
  step_ = Step::loading;
  image_.clear();
  block_ = 0;
  ++loads_;
  return {kLoadMark};
}

BootLoader::Bytes BootLoader::echo(std::span<const std::uint8_t> block) {
  Bytes answer(block.begin(), block.end());
  if (answer.size() > kMaxBlock) answer.resize(kMaxBlock);  // its buffer holds no more
  if (loads_ <= options_.bad_loads && block_ == options_.bad_block) {
    answer.back() ^= 0x10U;
    if (options_.silent_block) answer.clear();
  }
  image_.insert(image_.end(), answer.begin(), answer.end());
  ++block_;
  return answer;
}

bool BootLoader::can_run() const {
  if (step_ != Step::loading || image_.empty()) return false;
  return options_.image.empty() || equal(image_, options_.image);
}

}  // namespace touchtrial::device::falcon
