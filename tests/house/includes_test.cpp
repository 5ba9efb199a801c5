// The arrows of docs/architecture.md, held against every #include of the product.
#include "support/catch.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = TOUCHTRIAL_SOURCE_DIR;

/// Each layer and the layers that it may include besides itself.
const std::map<std::string, std::set<std::string>> kArrows = {
    {"core", {}},
    {"engine", {"core"}},
    {"device", {"core"}},
    {"protocols/store", {"core"}},
    {"protocols/collect", {"core", "protocols/store"}},
    {"protocols/design", {"core", "engine"}},
    {"protocols/session", {"core", "engine", "device", "protocols/store", "protocols/design"}},
    {"analysis", {"core", "engine", "protocols/store", "protocols/design"}},
    {"analysis/planning",
     {"core", "engine", "device", "protocols/store", "protocols/design", "protocols/session",
      "analysis"}},
    {"stimuli", {"core", "engine"}},
    {"app",
     {"core", "engine", "device", "protocols/store", "protocols/collect", "protocols/design",
      "protocols/session", "analysis", "analysis/planning", "stimuli"}},
    {"bench",
     {"core", "engine", "device", "protocols/store", "protocols/collect", "protocols/design",
      "protocols/session", "analysis", "analysis/planning", "stimuli", "app"}},
};

/// Layers that look inside the others, as tests do, and share the tests' slow references.
const std::set<std::string> kInsiders = {"bench"};

/// The most deeply nested layer that a path relative to the root belongs to; "" for none.
std::string layer_of(const std::string& path) {
  std::string best;
  for (const auto& [layer, unused] : kArrows) {
    if (path.starts_with(layer + "/") && layer.size() > best.size()) best = layer;
  }
  return best;
}

std::vector<std::string> product_files() {
  std::vector<std::string> files;
  for (const auto& [layer, unused] : kArrows) {
    if (!fs::exists(kRoot / layer)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / layer)) {
      const std::string extension = entry.path().extension().string();
      const std::string path = fs::relative(entry.path(), kRoot).generic_string();
      if ((extension == ".hpp" || extension == ".cpp") && layer_of(path) == layer) {
        files.push_back(path);
      }
    }
  }
  return files;
}

struct Includes {
  std::vector<std::string> quoted;
  std::vector<std::string> angled;
};

Includes includes_of(const std::string& path) {
  Includes includes;
  std::ifstream file(kRoot / path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("#include ") || line.size() < 11) continue;
    const char close = line[9] == '<' ? '>' : '"';
    const std::string name = line.substr(10, line.find(close, 10) - 10);
    (close == '>' ? includes.angled : includes.quoted).push_back(name);
  }
  return includes;
}

bool may_include(const std::string& from, const std::string& to) {
  return from == to || kArrows.at(from).count(to) > 0;
}

/// The C++ standard library's headers have neither folder nor ending; all others have.
bool is_third_party(const std::string& header) {
  return header.find('/') != std::string::npos || header.find('.') != std::string::npos;
}

bool shows_third_party(const std::string& path) {
  const Includes includes = includes_of(path);
  return std::any_of(includes.angled.begin(), includes.angled.end(), is_third_party);
}

bool includes_any_of(const std::string& path, const std::set<std::string>& headers) {
  const Includes includes = includes_of(path);
  return std::any_of(includes.quoted.begin(), includes.quoted.end(),
                     [&](const std::string& name) { return headers.count(name) > 0; });
}

/// Headers that show a third-party header themselves or by way of another header.
std::set<std::string> private_headers_among(const std::vector<std::string>& files) {
  std::set<std::string> found;
  while (true) {
    const std::size_t before = found.size();
    for (const std::string& path : files) {
      if (path.ends_with(".hpp") && (shows_third_party(path) || includes_any_of(path, found))) {
        found.insert(path);
      }
    }
    if (found.size() == before) return found;
  }
}

}  // namespace

TEST_CASE("no include runs against the arrows between the folders") {
  const std::vector<std::string> files = product_files();
  REQUIRE(files.size() > 50);
  for (const std::string& path : files) {
    for (const std::string& included : includes_of(path).quoted) {
      INFO(path << " includes " << included);
      REQUIRE(fs::exists(kRoot / included));
      if (kInsiders.count(layer_of(path)) > 0 && included.starts_with("tests/")) continue;
      const std::string to = layer_of(included);
      REQUIRE_FALSE(to.empty());
      CHECK(may_include(layer_of(path), to));
    }
  }
}

TEST_CASE("the arrows themselves have no cycle") {
  for (const auto& [layer, allowed] : kArrows) {
    for (const std::string& other : allowed) {
      INFO(layer << " and " << other);
      CHECK(kArrows.at(other).count(layer) == 0);
    }
  }
}

TEST_CASE("a header that shows a third-party header is private: no other layer includes it") {
  const std::vector<std::string> files = product_files();
  const std::set<std::string> private_headers = private_headers_among(files);
  REQUIRE_FALSE(private_headers.empty());
  for (const std::string& path : files) {
    for (const std::string& included : includes_of(path).quoted) {
      if (private_headers.count(included) == 0) continue;
      if (kInsiders.count(layer_of(path)) > 0) continue;
      INFO(path << " includes " << included << ", which shows a third-party header");
      CHECK(layer_of(path) == layer_of(included));
    }
  }
}

TEST_CASE("every header of the product guards itself and says what it is for") {
  for (const std::string& path : product_files()) {
    if (!path.ends_with(".hpp")) continue;
    std::ifstream file(kRoot / path);
    std::string first;
    std::getline(file, first);
    INFO(path);
    CHECK(first.starts_with("/// \\file "));
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    // An -inl header is read once for every SIMD target, by the target macro's rules.
    const bool once_a_target = path.ends_with("-inl.hpp");
    CHECK((once_a_target || text.find("#pragma once") != std::string::npos));
  }
}
