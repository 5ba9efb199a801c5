/// \file Everything of each trial that a database tells without a key.
#pragma once

#include "core/files.hpp"
#include "protocols/simulation/permutations.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <nlohmann/json.hpp>

namespace touchtrial {

/// Numbers as they are, texts as their place among all texts of the feature.
class FeatureReader {
 public:
  void add(const std::string& name, double value) { numbers_[name].push_back(value); }
  void add(const std::string& name, const std::string& text) { texts_[name].push_back(text); }
  [[nodiscard]] Features features() const {
    Features features = numbers_;
    for (const auto& [name, texts] : texts_) {
      const std::set<std::string> kinds(texts.begin(), texts.end());
      for (const std::string& text : texts) {
        const auto place = std::distance(kinds.begin(), kinds.find(text));
        features[name].push_back(static_cast<double>(place));
      }
    }
    return features;
  }

 private:
  Features numbers_;
  std::map<std::string, std::vector<std::string>> texts_;
};

/// The events of one trial.
struct SeenTrial {
  std::string kinds;
  std::string sizes;
  std::string bodies;
  double sealed_bytes = 0.0;
  double body_bytes = 0.0;
  std::map<std::string, double> numbers;  ///< in the bodies, by key
};

/// Every number of a body, and of an object in it.
inline void add_numbers(const nlohmann::json& body, const std::string& place, SeenTrial& trial) {
  for (const auto& [key, value] : body.items()) {
    if (value.is_object()) add_numbers(value, place + key + "/", trial);
    if (value.is_number()) trial.numbers[place + key] = value.get<double>();
    if (value.is_boolean()) trial.numbers[place + key] = value.get<bool>() ? 1.0 : 0.0;
  }
}

inline double number_of_hex(const SQLite::Column& digits) {
  return std::stoi(digits.getString(), nullptr, 16);
}

inline void add_event(SQLite::Statement& event, nlohmann::json body, SeenTrial& trial) {
  const std::string kind = event.getColumn("kind").getString();
  const int sealed_bytes = event.getColumn("sealed_bytes").getInt();
  trial.body_bytes += static_cast<double>(body.dump().size());
  body.erase("trial");
  body.erase("trace");
  add_numbers(body, kind + "/", trial);
  body.erase("servo");
  trial.kinds += kind + ",";
  trial.sizes += std::to_string(sealed_bytes) + ",";
  trial.sealed_bytes += sealed_bytes;
  trial.bodies += body.dump();
  trial.numbers[kind + "'s time"] = event.getColumn("at_ns").getDouble();
  trial.numbers[kind + "'s sequence"] = event.getColumn("sequence").getDouble();
  trial.numbers[kind + "'s first sealed byte"] = number_of_hex(event.getColumn("first_byte"));
}

inline void add_events(SQLite::Database& database, FeatureReader& seen) {
  SQLite::Statement events(
      database,
      "SELECT session, sequence, kind, at_ns, body, length(sealed) AS sealed_bytes, "
      "hex(substr(sealed, 1, 1)) AS first_byte FROM events WHERE session > 0 "
      "ORDER BY session, sequence");
  std::map<std::pair<int, int>, SeenTrial> trials;
  while (events.executeStep()) {
    const nlohmann::json body = nlohmann::json::parse(events.getColumn("body").getString());
    if (!body.contains("trial")) continue;
    add_event(events, body, trials[{events.getColumn("session").getInt(), body.at("trial")}]);
  }
  for (const auto& [id, trial] : trials) {
    seen.add("order of events", trial.kinds);
    seen.add("sizes of events", trial.sizes);
    seen.add("bytes of sealed parts", trial.sealed_bytes);
    seen.add("bytes of bodies without numbers", static_cast<double>(trial.bodies.size()));
    seen.add("bytes of bodies", trial.body_bytes);
    seen.add("bodies without the servo", trial.bodies);
    for (const auto& [name, number] : trial.numbers) seen.add(name, number);
  }
}

/// Where the pages of a file are that begin with given bytes after the link to the next page.
class Pages {
 public:
  explicit Pages(const std::filesystem::path& path) : bytes_(read_file(path)) {
    const std::size_t size = std::size_t{bytes_.at(16)} * 256 + bytes_.at(17);
    for (std::size_t at = size; at + size <= bytes_.size(); at += size) {
      pages_[part(bytes_, at + kLink)] = at / size;
    }
    size_ = size;
  }
  /// The page on which a long value goes on first.
  [[nodiscard]] std::optional<double> first_of(const std::string& value) {
    for (const std::size_t at : {last_found_, std::size_t{0}}) {
      for (std::size_t i = at; i < size_ && i + kProbe <= value.size(); ++i) {
        const auto found = pages_.find(std::string_view(value).substr(i, kProbe));
        if (found == pages_.end()) continue;
        last_found_ = i;
        return static_cast<double>(found->second);
      }
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kLink = 4;
  static constexpr std::size_t kProbe = 24;
  static std::string part(const Bytes& bytes, std::size_t at) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    return {begin, begin + kProbe};
  }
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  Bytes bytes_;
  std::size_t size_ = 0;
  std::unordered_map<std::string, std::size_t, Hash, std::equal_to<>> pages_;
  std::size_t last_found_ = 0;
};

inline void add_traces(SQLite::Database& database, const std::filesystem::path& path,
                       FeatureReader& seen) {
  Pages pages(path);
  SQLite::Statement traces(database,
                           "SELECT length(box), rowid, substr(box, 1, 16384), "
                           "hex(substr(box, 1, 1)) FROM traces ORDER BY session, trial");
  double row_before = 0.0;
  double page_before = 0.0;
  while (traces.executeStep()) {
    const double row = traces.getColumn(1).getDouble();
    const double page = pages.first_of(traces.getColumn(2).getString()).value();
    seen.add("a trace's bytes", traces.getColumn(0).getDouble());
    seen.add("a trace's row", row - row_before);
    seen.add("a trace's first byte", number_of_hex(traces.getColumn(3)));
    seen.add("pages from trace to trace", page - page_before);
    row_before = row;
    page_before = page;
  }
}

/// Everything of each trial that a database tells without a key.
inline Features features_in_clear(const std::filesystem::path& path) {
  SQLite::Database database(path.string(), SQLite::OPEN_READONLY);
  FeatureReader seen;
  add_events(database, seen);
  add_traces(database, path, seen);
  return seen.features();
}

}  // namespace touchtrial
