#include "app/readings/history.hpp"

#include <algorithm>

namespace touchtrial::app {
namespace {

/// The number of bins for one rate.
constexpr std::size_t kRateBins = 5;

}  // namespace

void Extent::add(double value) noexcept {
  least = std::min(least, value);
  greatest = std::max(greatest, value);
}

ReadingsHistory::ReadingsHistory(double rate_hz) : rate_hz_(rate_hz), bins_(kBins) {}

void ReadingsHistory::add(const device::ServoSample& sample) {
  if (sample.tick <= last_tick_) {
    bins_.assign(kBins, Bin{});
    newest_ = -1;
  }
  last_tick_ = sample.tick;
  const auto number =
      static_cast<std::int64_t>(static_cast<double>(sample.tick) * kBinsPerS / rate_hz_);
  const std::int64_t unseen = std::min<std::int64_t>(number - newest_, kBins);
  for (std::int64_t back = 0; back < unseen; ++back) bin_at(number - back) = Bin{};
  newest_ = number;
  Bin& bin = bin_at(number);
  ++bin.samples;
  const Vec3 p = sample.position_mm;
  const Vec3 f = sample.force_n;
  const std::array<double, 6> values = {p.x, p.y, p.z, f.x, f.y, f.z};
  for (std::size_t i = 0; i < values.size(); ++i) bin.channels[i].add(values[i]);
}

void ReadingsHistory::add_lateness(double late_us) {
  if (newest_ < 0) return;
  bin_at(newest_).channels[static_cast<std::size_t>(Channel::late)].add(late_us);
}

std::vector<Extent> ReadingsHistory::values(Channel channel) const {
  std::vector<Extent> values(kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    values[i] = from_oldest(i).channels[static_cast<std::size_t>(channel)];
  }
  return values;
}

std::vector<Extent> ReadingsHistory::rates_hz() const {
  std::vector<Extent> rates(kBins);
  // The newest bin is still being filled.
  for (std::size_t i = kRateBins - 1; i + 1 < kBins; ++i) {
    int samples = 0;
    for (std::size_t back = 0; back < kRateBins; ++back) samples += from_oldest(i - back).samples;
    const bool began_before = from_oldest(i + 1 - kRateBins).samples > 0;
    if (began_before) rates[i].add(samples / (kRateBins * kBinS));
  }
  return rates;
}

ReadingsHistory::Bin& ReadingsHistory::bin_at(std::int64_t number) noexcept {
  constexpr auto kCount = static_cast<std::int64_t>(kBins);
  return bins_[static_cast<std::size_t>((number % kCount + kCount) % kCount)];
}

const ReadingsHistory::Bin& ReadingsHistory::from_oldest(std::size_t index) const noexcept {
  const auto place = static_cast<std::size_t>(newest_ + 1) + index;
  return bins_[place % kBins];
}

}  // namespace touchtrial::app
