/// \file Holds a JSON Schema against the reader of its files: every statement of the schema is tried
/// on the reader, and the reader's keys are looked up in the schema.
#pragma once

#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {

class SchemaAgainstReader {
 public:
  using json = nlohmann::json;
  using Pointer = json::json_pointer;

  /// A place of a file, and what the schema says of it.
  struct Place {
    Pointer pointer;
    json rule;
    bool is_one_of = false;  ///< of several rules
  };

  /// \param refusal  the error for a file; empty if it is accepted
  /// \param complete  adds to a file what a value at this place needs beside it
  /// \param is_other  whether a number at this place is refused for another reason than its bounds
  SchemaAgainstReader(
      json schema, std::function<std::string(const json& file)> refusal,
      std::function<void(const Pointer& place, json& file)> complete = [](const Pointer&, json&) {},
      std::function<bool(const Pointer& place, double number)> is_other =
          [](const Pointer&, double) { return false; })
      : schema_(std::move(schema)),
        refusal_(std::move(refusal)),
        complete_(std::move(complete)),
        is_other_(std::move(is_other)) {
    collect(schema_, Pointer());
  }

  [[nodiscard]] const std::vector<Place>& objects() const { return objects_; }
  [[nodiscard]] const std::vector<Place>& leaves() const { return leaves_; }
  /// \return the error for a file with this value; empty if it is accepted
  [[nodiscard]] std::string refusal(const Pointer& place, const json& value) const {
    return refusal_(file_with(place, value));
  }

  /// Keys, those that are required, and the examples.
  void check_keys() const {
    for (const Place& object : objects_) {
      INFO("in " << object.pointer.to_string());
      CHECK(object.rule.at("additionalProperties") == false);
      std::set<std::string> in_schema;
      for (const auto& [key, unused] : object.rule.at("properties").items()) in_schema.insert(key);
      CHECK(known_keys_in(refusal(object.pointer / "qqqqqqqqqqqqqqqqqqqqqqqqqq", 1)) == in_schema);
      for (const std::string key : object.rule.value("required", json::array())) {
        json file = file_with(object.pointer / key, "left out");
        file[object.pointer].erase(key);
        CHECK_THAT(refusal_(file), holds_text(key));
      }
    }
    for (const json& example : schema_.at("examples")) CHECK(refusal_(example).empty());
  }

  /// A refusal names the place.
  /// \return how many bounds there are
  int check_bounds() const {
    int bounds = 0;
    for (const Place& leaf : leaves_) {
      bounds += holds_bound(leaf, "minimum", -1.0, true) ? 1 : 0;
      bounds += holds_bound(leaf, "maximum", 1.0, true) ? 1 : 0;
      bounds += holds_bound(leaf, "exclusiveMinimum", -1.0, false) ? 1 : 0;
      bounds += holds_bound(leaf, "exclusiveMaximum", 1.0, false) ? 1 : 0;
    }
    return bounds;
  }

  /// Types, words, texts, lengths of lists, and that defaults are accepted. A refusal of another
  /// type names the place, and that of a word the possible ones.
  void check_values() const {
    for (const Place& leaf : leaves_) {
      INFO(leaf.pointer.to_string());
      const auto takes = [&](const json& value) { return refusal(leaf.pointer, value).empty(); };
      const std::string type = leaf.rule.value("type", "string");
      for (const json& value : {json("diagonal"), json(3.5), json(true), json::array({0, 1, 2}),
                                json::object(), json()}) {
        const bool fits = type == value.type_name() && !leaf.rule.contains("enum");
        if (!fits && !leaf.is_one_of) check_refused(leaf.pointer, value);
      }
      for (const json& word : leaf.rule.value("enum", json::array())) {
        CHECK(takes(word));
        CHECK_THAT(refusal(leaf.pointer, "diagonal"), holds_text(word.get<std::string>()));
      }
      if (type == "string" && !leaf.rule.contains("enum")) {
        CHECK(takes("a b"));
        CHECK(takes("") == !leaf.rule.contains("minLength"));
      }
      if (leaf.rule.contains("pattern")) {
        CHECK(leaf.rule.at("pattern") == R"(^[^\u0000-\u001f\u007f]*$)");
        for (const char* text : {"\x01", "a\x1f", "a\x7fz"}) CHECK_FALSE(takes(text));
      }
      if (type == "array") {
        CHECK_FALSE(takes(json::array({0, 0})));
        CHECK_FALSE(takes(json::array({0, 0, 0, 0})));
      }
      if (leaf.rule.contains("default")) CHECK(takes(leaf.rule.at("default")));
    }
  }

  /// \return a file with every default of the schema
  [[nodiscard]] json defaults() const {
    json file = json::object();
    for (const Place& leaf : leaves_) {
      if (leaf.rule.contains("default")) file[leaf.pointer] = leaf.rule.at("default");
    }
    return file;
  }

 private:
  [[nodiscard]] json resolved(const json& node) const {
    if (!node.contains("$ref")) return node;
    return schema_.at(Pointer(node.at("$ref").get<std::string>().substr(1)));
  }

  void collect(const json& node, const Pointer& place) {
    const json rule = resolved(node);
    if (rule.contains("anyOf")) {
      for (const json& one : rule.at("anyOf")) leaves_.push_back({place, resolved(one), true});
      return;
    }
    // Of an object that may have any key, the reader knows none.
    if (rule.value("type", "") != "object" || rule.at("additionalProperties") == true) {
      leaves_.push_back({place, rule});
      return;
    }
    objects_.push_back({place, rule});
    for (const auto& [key, property] : rule.at("properties").items()) {
      // Another name of a section.
      if (property.value("$ref", "").starts_with("#/properties/")) continue;
      collect(property, place / key);
    }
  }

  [[nodiscard]] json file_with(const Pointer& place, const json& value) const {
    json file = json::object();
    file[place] = value;
    complete_(place, file);
    file[place] = value;
    return file;
  }

  /// \param message  of an error about an unknown key, which ends with "known here: a, b, c"
  static std::set<std::string> known_keys_in(const std::string& message) {
    const std::string mark = "known here: ";
    REQUIRE(message.find(mark) != std::string::npos);
    std::string list = message.substr(message.find(mark) + mark.size()) + ", ";
    std::set<std::string> keys;
    for (auto end = list.find(", "); end != std::string::npos; end = list.find(", ")) {
      keys.insert(list.substr(0, end));
      list.erase(0, end + 2);
    }
    return keys;
  }

  /// \return a list of three: `number` first, with others that are valid beside it
  static json in_list(const json& rule, double number) {
    if (!rule.contains("uniqueItems")) {
      const double other = std::max(0.0, rule.at("items").at("minimum").get<double>());
      return json::array({number, other, other});
    }
    json list = json::array({number});
    for (int other = 0; list.size() < 3; ++other) {
      if (other != number) list.push_back(other);
    }
    return list;
  }

  void check_refused(const Pointer& place, const json& value) const {
    CHECK_THAT(refusal(place, value), holds_text(place.to_string()));
  }

  /// Tries one bound, and the nearest numbers to either side of it.
  /// \return whether the schema has the bound
  bool holds_bound(const Place& leaf, const char* word, double outwards, bool belongs) const {
    const bool listed = leaf.rule.contains("items");
    const json rule = listed ? leaf.rule.at("items") : leaf.rule;
    if (!rule.contains(word)) return false;
    const double bound = rule.at(word);
    const double step = rule.at("type") == "integer" ? 1.0 : 1e-9 * std::max(1.0, std::abs(bound));
    INFO(leaf.pointer.to_string() << " " << word);
    const auto expect = [&](double number, bool taken) {
      if (taken && is_other_(leaf.pointer, number)) return;
      const json value = listed ? in_list(leaf.rule, number) : json(number);
      if (taken) {
        CHECK(refusal(leaf.pointer, value).empty());
      } else {
        check_refused(leaf.pointer, value);
      }
    };
    expect(bound, belongs);
    expect(bound - outwards * step, true);
    constexpr double kLastWhole = 9e15;  // that has its own number
    if (std::abs(bound) < kLastWhole) expect(bound + outwards * step, false);
    return true;
  }

  json schema_;
  std::function<std::string(const json&)> refusal_;
  std::function<void(const Pointer&, json&)> complete_;
  std::function<bool(const Pointer&, double)> is_other_;
  std::vector<Place> objects_;
  std::vector<Place> leaves_;
};

}  // namespace touchtrial
