#include "device/drivers/replay/replay_device.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "device/drivers/drivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::device {
namespace {

constexpr std::uintmax_t kMaxFile = std::uintmax_t{512} << 20U;
constexpr double kMaxMm = 10'000.0;
constexpr double kMinHz = 10.0;
constexpr double kMaxHz = 20'000.0;
constexpr std::array<std::string_view, 4> kColumns = {"time_s", "x_mm", "y_mm", "z_mm"};

struct CsvRow {
  std::vector<std::string> fields;
  std::size_t line = 0;  ///< from 1
};

[[noreturn]] void refuse(const std::string& where, const std::string& problem) {
  throw FileError(one_line(where + ": " + problem));
}

/// Rows of a CSV file: commas separate fields, LF or CRLF rows. Quotation marks around a field and
/// a leading byte order mark are removed.
class CsvRows {
 public:
  /// \param text  must outlive this
  explicit CsvRows(std::string_view text) : rest_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }

  /// \return false at the end
  [[nodiscard]] bool next(CsvRow& row) {
    if (rest_.empty()) return false;
    std::string_view text = cut(rest_, '\n');
    if (text.ends_with('\r')) text.remove_suffix(1);
    row = {{}, ++line_};
    do {
      std::string_view field = cut(text, ',');
      if (field.size() > 1 && field.front() == '"' && field.back() == '"') {
        field = field.substr(1, field.size() - 2);
      }
      row.fields.emplace_back(field);
    } while (text.data() != nullptr);
    return true;
  }

 private:
  /// Removes and returns the text before the first separator, or the whole text without one.
  static std::string_view cut(std::string_view& text, char mark) {
    const std::size_t end = text.find(mark);
    const std::string_view before = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    return before;
  }

  std::string_view rest_;
  std::size_t line_ = 0;
};

struct TimedPosition {
  double time_s;
  Vec3 position_mm;
};

std::array<std::size_t, 4> find_columns(const CsvRow& header, const std::string& where) {
  std::array<std::size_t, 4> columns{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto field = std::ranges::find(header.fields, kColumns[i]);
    if (field == header.fields.end()) {
      refuse(where, "no column " + std::string(kColumns[i]) +
                        "; the header must name time_s, x_mm, y_mm, z_mm");
    }
    columns[i] = static_cast<std::size_t>(field - header.fields.begin());
  }
  return columns;
}

double parse_motion_number(const std::string& text, std::string_view column,
                           const std::string& where) {
  const auto value = number_in<double>(text);
  if (!value || !std::isfinite(*value)) {
    refuse(where, std::string(column) + " is not a number: '" + text.substr(0, 40) + "'");
  }
  return *value;
}

TimedPosition parse_position(const CsvRow& row, const std::array<std::size_t, 4>& columns,
                             const std::string& where) {
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = parse_motion_number(row.fields[columns[i]], kColumns[i], where);
    if (i > 0 && std::abs(values[i]) > kMaxMm) {
      refuse(where, std::string(kColumns[i]) + " is beyond 10 m; positions are in millimetres");
    }
  }
  return {values[0], {values[1], values[2], values[3]}};
}

std::vector<TimedPosition> read_positions(CsvRows& rows, const std::string& name) {
  CsvRow row;
  if (!rows.next(row)) refuse(name, "is empty; it needs a header and rows of numbers");
  const auto columns = find_columns(row, name + ", line 1");
  const std::size_t width = row.fields.size();
  std::vector<TimedPosition> positions;
  while (rows.next(row)) {
    const std::string where = name + ", line " + std::to_string(row.line);
    if (row.fields.size() != width) {
      refuse(where, std::to_string(row.fields.size()) + " fields where the header has " +
                        std::to_string(width));
    }
    positions.push_back(parse_position(row, columns, where));
    if (positions.size() > 1 && !(positions.back().time_s > (positions.end() - 2)->time_s)) {
      refuse(where, "time_s does not increase; sort the rows by time");
    }
  }
  if (positions.size() < 2) refuse(name, "has fewer than two rows of positions");
  return positions;
}

/// \return the median time from one row to the next
double median_step_s(const std::vector<TimedPosition>& rows) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    steps.push_back(rows[i].time_s - rows[i - 1].time_s);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// \return the position at every tick, with linear interpolation of missing rows
std::vector<Vec3> fill_ticks(const std::vector<TimedPosition>& rows, double step_s,
                             const std::string& name) {
  std::vector<Vec3> positions = {rows.front().position_mm};
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Vec3 start_mm = rows[i - 1].position_mm;
    const Vec3 change_mm = rows[i].position_mm - start_mm;
    const double steps = std::round((rows[i].time_s - rows[i - 1].time_s) / step_s);
    if (steps < 1.0) refuse(name, "some rows are much closer in time than the others");
    if (steps + static_cast<double>(positions.size()) > RecordedMotion::kMaxTicks) {
      refuse(name, "is longer than " + std::to_string(RecordedMotion::kMaxTicks) + " ticks");
    }
    for (double k = 1.0; k < steps; ++k) positions.push_back(start_mm + (k / steps) * change_mm);
    positions.push_back(rows[i].position_mm);
  }
  return positions;
}

/// \return the mean rate of the recording, rounded to 1 mHz, so that rounded times have no effect
double recording_rate(double duration_s, std::size_t ticks, const std::string& name) {
  const double rate_hz = std::round(static_cast<double>(ticks - 1) / duration_s * 1000.0) / 1000.0;
  if (rate_hz >= kMinHz && rate_hz <= kMaxHz) return rate_hz;
  refuse(name, "does not have 10 to 20,000 rows per second; time_s is in seconds");
}

/// The peak force of a typical device.
constexpr double kMaxForceN = 3.3;

RecordedMotion motion_of(const DeviceSettings& settings) {
  if (settings.replay.trace.empty()) {
    throw DeviceError(
        "replay: no recording is named; name a CSV file in the device settings at replay.trace");
  }
  return read_motion_csv(settings.replay.trace);
}

std::vector<DeviceListing> list_replay(const DeviceSettings& settings) {
  DeviceListing listing;
  listing.driver = "replay";
  listing.where = settings.replay.trace.string();
  try {
    (void)motion_of(settings);
    listing.model = "recorded motion";
    listing.present = true;
  } catch (const Error& error) {
    listing.missing = {error.what()};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> open_replay(const DeviceSettings& settings) {
  return std::make_unique<ReplayDevice>(motion_of(settings));
}

}  // namespace

RecordedMotion::RecordedMotion(std::vector<Vec3> positions_mm, double rate_hz)
    : positions_mm_(std::move(positions_mm)), rate_hz_(rate_hz) {
  if (positions_mm_.empty() || ticks() > kMaxTicks || !(rate_hz > 0.0) || !std::isfinite(rate_hz)) {
    throw std::invalid_argument("RecordedMotion: no positions, too many, or a rate not above 0");
  }
}

RecordedMotion read_motion_csv(const std::filesystem::path& file) {
  const Bytes bytes = read_file(file, kMaxFile);
  const std::string name = file.string();
  CsvRows rows({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::vector<TimedPosition> positions = read_positions(rows, name);
  std::vector<Vec3> ticks = fill_ticks(positions, median_step_s(positions), name);
  const double duration_s = positions.back().time_s - positions.front().time_s;
  const double rate_hz = recording_rate(duration_s, ticks.size(), name);
  return {std::move(ticks), rate_hz};
}

DeviceInfo ReplayDevice::info() const {
  DeviceInfo info{"replay", "", kMaxForceN, true};
  info.max_rate_hz = motion_.rate_hz();
  return info;
}

DeviceStatus ReplayDevice::read(DeviceSample& sample) noexcept {
  const std::int64_t last = motion_.ticks() - 1;
  const std::int64_t tick = tick_ < last ? tick_ : last;
  sample = {};
  sample.position_mm = motion_.position_mm(tick);
  if (tick > 0) {
    const Vec3 step_mm = sample.position_mm - motion_.position_mm(tick - 1);
    sample.velocity_mm_s = motion_.rate_hz() * step_mm;
  }
  sample.sequence = static_cast<std::uint64_t>(tick_) + 1;
  return tick_ <= last ? DeviceStatus::ok : DeviceStatus::stopped;
}

DeviceStatus ReplayDevice::write(Vec3) noexcept {
  ++tick_;
  return DeviceStatus::ok;
}

DeviceDriver replay_driver() {
  return {"replay", "recorded motion from a CSV file; feels nothing", list_replay, open_replay};
}

}  // namespace touchtrial::device
