#include "app/monitor/monitor_history.hpp"

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

MonitorHistory::MonitorHistory(double rate_hz) : rate_hz_(rate_hz), bins_(kBins) {}

void MonitorHistory::add(const device::ServoSample& sample) {
  if (sample.tick <= last_tick_) {
    bins_.assign(kBins, Bin{});
    newest_ = -1;
    told_until_ = -1;
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

void MonitorHistory::add_lateness(double late_us) {
  const std::int64_t oldest = newest_ + 1 - static_cast<std::int64_t>(kBins);
  for (std::int64_t bin = std::max({told_until_ + 1, oldest, std::int64_t{0}}); bin < newest_;
       ++bin) {
    bin_at(bin).lateness_us.add(late_us);
  }
  if (newest_ >= 0) bin_at(newest_).lateness_us.add(late_us);
  told_until_ = newest_;
}

std::vector<Extent> MonitorHistory::values(Channel channel) const {
  std::vector<Extent> values(kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    values[i] = from_oldest(i).channels[static_cast<std::size_t>(channel)];
  }
  return values;
}

std::vector<Extent> MonitorHistory::rates_hz() const {
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

std::vector<Extent> MonitorHistory::lateness_us() const {
  std::vector<Extent> lateness(kBins);
  for (std::size_t i = 0; i < kBins; ++i) lateness[i] = from_oldest(i).lateness_us;
  return lateness;
}

MonitorHistory::Bin& MonitorHistory::bin_at(std::int64_t number) noexcept {
  constexpr auto kCount = static_cast<std::int64_t>(kBins);
  return bins_[static_cast<std::size_t>((number % kCount + kCount) % kCount)];
}

const MonitorHistory::Bin& MonitorHistory::from_oldest(std::size_t index) const noexcept {
  const auto place = static_cast<std::size_t>(newest_ + 1) + index;
  return bins_[place % kBins];
}

}  // namespace touchtrial::app
