#include "protocols/design/prepare_notes.hpp"

#include <array>
#include <cstddef>
#include <exception>

#include <nlohmann/json.hpp>

namespace touchtrial::design {
namespace {

using nlohmann::json;

json json_of(const FileStamp& stamp) {
  return {stamp.bytes, stamp.inode, stamp.modified_ns, stamp.changed_ns, stamp.taken_ns};
}

FileStamp stamp_in(const json& value) {
  return {value.at(0).get<std::uint64_t>(), value.at(1).get<std::uint64_t>(),
          value.at(2).get<std::int64_t>(), value.at(3).get<std::int64_t>(),
          value.at(4).get<std::int64_t>()};
}

Digest digest_in(const json& value) {
  return digest_from_hex(value.get<std::string>()).value();
}

constexpr std::array kNumbers{
    &engine::FieldStatistics::tangential_rms_n, &engine::FieldStatistics::tangential_p999_n,
    &engine::FieldStatistics::normal_rms_n, &engine::FieldStatistics::stiffness_p99_n_per_mm,
    &engine::FieldStatistics::share_below_1_mm};

json json_of(const engine::FieldStatistics& statistics) {
  json numbers = json::array();
  for (const auto number : kNumbers) numbers.push_back(statistics.*number);
  for (const double share : statistics.share_above_250_hz) numbers.push_back(share);
  return numbers;
}

engine::FieldStatistics statistics_in(const json& value) {
  engine::FieldStatistics statistics;
  std::size_t i = 0;
  for (const auto number : kNumbers) statistics.*number = value.at(i++).get<double>();
  for (double& share : statistics.share_above_250_hz) share = value.at(i++).get<double>();
  return statistics;
}

json json_of(const MeasuredFields& measured) {
  json gains = json::array();
  for (const engine::Gains& of_field : measured.gains.of_field) {
    json numbers = json::array();
    for (const engine::NamedGain& gain : engine::kGains) numbers.push_back(of_field.*gain.value);
    gains.push_back(numbers);
  }
  json statistics = json::array();
  for (const engine::FieldStatistics& one : measured.statistics) statistics.push_back(json_of(one));
  return {{"of", to_hex(measured.of)},
          {"gains", gains},
          {"over_budget", measured.gains.over_budget},
          {"remarks", measured.remarks},
          {"flat", measured.flat},
          {"statistics", statistics}};
}

MeasuredFields measured_in(const json& value) {
  MeasuredFields measured;
  measured.of = digest_in(value.at("of"));
  for (const json& numbers : value.at("gains")) {
    engine::Gains& gains = measured.gains.of_field.emplace_back();
    std::size_t i = 0;
    for (const engine::NamedGain& gain : engine::kGains) {
      gains.*gain.value = numbers.at(i++).get<double>();
    }
  }
  measured.gains.over_budget = value.at("over_budget").get<bool>();
  measured.remarks = value.at("remarks").get<std::vector<std::string>>();
  measured.flat = value.at("flat").get<std::vector<std::uint8_t>>();
  for (const json& one : value.at("statistics")) measured.statistics.push_back(statistics_in(one));
  return measured;
}

}  // namespace

std::string text_of_notes(const PrepareNotes& notes) {
  json pictures = json::object();
  for (const auto& [path, note] : notes.pictures) {
    pictures[path] = {json_of(note.stamp), to_hex(note.pixels), note.size_px};
  }
  json fields = json::object();
  for (const auto& [code, note] : notes.fields) {
    fields[code] = {to_hex(note.recipe), to_hex(note.pixels), to_hex(note.tag),
                    to_hex(note.checksum), json_of(note.stamp)};
  }
  json all = {{"pictures", pictures}, {"fields", fields}};
  if (notes.measured) all["measured"] = json_of(*notes.measured);
  return all.dump(-1, ' ', false, json::error_handler_t::replace);
}

PrepareNotes notes_of_text(const std::string& text) {
  PrepareNotes notes;
  try {
    const json all = json::parse(text);
    for (const auto& [path, note] : all.at("pictures").items()) {
      notes.pictures[path] = {stamp_in(note.at(0)), digest_in(note.at(1)),
                              note.at(2).get<std::int64_t>()};
    }
    for (const auto& [code, note] : all.at("fields").items()) {
      notes.fields[code] = {digest_in(note.at(0)), digest_in(note.at(1)), digest_in(note.at(2)),
                            digest_in(note.at(3)), stamp_in(note.at(4))};
    }
    if (all.contains("measured")) notes.measured = measured_in(all["measured"]);
    return notes;
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace touchtrial::design
