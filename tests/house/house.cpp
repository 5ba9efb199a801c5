#include "house/house.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <utility>

namespace touchtrial::house {
namespace {

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The room with the longest folder that a path lies in; null for none.
const Room* room_of(const std::string& path) {
  const Room* best = nullptr;
  for (const Room& room : rooms()) {
    if (!path.starts_with(room.folder + "/")) continue;
    if (best == nullptr || room.folder.size() > best->folder.size()) best = &room;
  }
  return best;
}

void read_includes(SourceFile& file) {
  std::istringstream lines(file.text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("#include ") || line.size() < 11) continue;
    const char close = line[9] == '<' ? '>' : '"';
    const std::string name = line.substr(10, line.find(close, 10) - 10);
    const bool is_ours = close != '>' || room_of(name) != nullptr;
    (is_ours ? file.quoted : file.angled).push_back(name);
  }
}

/// The C++ standard library's headers have neither folder nor ending; all others have.
bool is_third_party(const std::string& header) {
  return header.find_first_of("/.") != header.npos;
}

/// The folder that a header says it is private to: the one it names, else its own; "" for none.
std::string private_to(const SourceFile& header) {
  std::string comment;
  std::istringstream lines(header.text);
  for (std::string line; std::getline(lines, line) && line.starts_with("///");) {
    comment += line.substr(3);
  }
  std::smatch found;
  if (!std::regex_search(comment, found, std::regex("Private to\\s+([\\w/]*\\w)"))) return "";
  const std::string own = fs::path(header.path).parent_path().generic_string();
  const std::string named = found[1];
  return (own + "/").starts_with(named + "/") ? named : own;
}

std::string kind_of(const Definition& definition) {
  switch (definition.kind) {
    case Definition::Kind::type:
      return "type ";
    case Definition::Kind::function:
      return "function ";
    case Definition::Kind::variable:
      return "variable ";
  }
  return "";
}

/// A protocol's part belongs to its layer: its namespace lies in the layer's.
bool in_one_layer(const Room& part, const Room* layer) {
  if (layer == nullptr) return false;
  return layer == &part || (layer->name_space != "touchtrial" &&
                            part.name_space.starts_with(layer->name_space + "::"));
}

bool one_in_the_program(const Definition& definition) {
  return definition.kind == Definition::Kind::type || definition.is_inline;
}

}  // namespace

const std::vector<Room>& rooms() {
  static const std::vector<Room> all = [] {
    const std::set<std::string> session = {"core", "engine", "device", "protocols/store",
                                           "protocols/design"};
    const std::set<std::string> analysis = {"core", "engine", "protocols/store",
                                            "protocols/design"};
    std::set<std::string> simulation = session;
    simulation.insert("protocols/session");
    std::set<std::string> planning = simulation;
    planning.insert({"protocols/simulation", "analysis", "protocols/identification/analysis"});
    std::set<std::string> identified = simulation;
    identified.insert({"protocols/simulation", "protocols/identification/design"});
    std::set<std::string> analysed = analysis;
    analysed.insert({"analysis", "protocols/identification/design"});
    std::set<std::string> registered = planning;
    registered.insert({"protocols/identification/design", "protocols/identification/simulation",
                       "protocols/identification/analysis"});
    std::set<std::string> app = registered;
    app.insert("protocols/registration");
    app.insert({"protocols/collect", "analysis/planning", "stimuli"});
    std::set<std::string> bench = app;
    bench.insert("app");
    return std::vector<Room>{
        {"core", "touchtrial", {}},
        {"engine", "touchtrial::engine", {"core"}},
        {"device", "touchtrial::device", {"core"}},
        {"protocols/store", "touchtrial::store", {"core"}},
        {"protocols/collect", "touchtrial::collect", {"core", "protocols/store"}},
        {"protocols/design", "touchtrial::design", {"core", "engine"}},
        {"protocols/identification/design",
         "touchtrial::design::identification",
         {"core", "engine", "protocols/design"}},
        {"protocols/session", "touchtrial::session", session},
        {"protocols/simulation", "touchtrial::simulation", simulation},
        {"protocols/identification/simulation", "touchtrial::simulation::identification",
         identified},
        {"analysis", "touchtrial::analysis", analysis},
        {"protocols/identification/analysis", "touchtrial::analysis::identification", analysed},
        {"analysis/planning", "touchtrial::planning", planning},
        {"protocols/registration", "touchtrial::registration", registered},
        {"stimuli", "touchtrial::stimuli", {"core", "engine"}},
        {"app", "touchtrial::app", app},
        {"bench", "touchtrial::bench", bench, true},
    };
  }();
  return all;
}

House::House(fs::path root) : root_(std::move(root)) {
  for (const Room& room : rooms()) {
    if (!fs::exists(root_ / room.folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root_ / room.folder)) {
      const std::string ending = entry.path().extension().string();
      const std::string path = fs::relative(entry.path(), root_).generic_string();
      if ((ending != ".hpp" && ending != ".cpp") || room_of(path) != &room) continue;
      SourceFile file{path, &room, text_of_file(entry.path()), {}, {}, {}};
      read_includes(file);
      file.declared = declarations_in(file.text);
      files_.push_back(std::move(file));
    }
  }
  std::sort(files_.begin(), files_.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
}

const SourceFile* House::find(const std::string& path) const {
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [&](const SourceFile& file) { return file.path == path; });
  return found == files_.end() ? nullptr : &*found;
}

std::vector<std::string> House::wrong_includes() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    for (const std::string& name : file.quoted) {
      const std::string what = file.path + " includes " + name;
      if (file.room->sees_inside && name.starts_with("tests/")) continue;
      const Room* to = room_of(name);
      if (!fs::exists(root_ / name)) {
        found.push_back(what + ", which is not there");
      } else if (to == nullptr) {
        found.push_back(what + ", which is in no room");
      } else if (to != file.room && file.room->arrows.count(to->folder) == 0) {
        found.push_back(what + " against the arrows");
      }
    }
  }
  return found;
}

std::vector<std::string> House::third_party_headers_shown() const {
  std::set<std::string> showing;
  for (std::size_t before = files_.size(); before != showing.size();) {
    before = showing.size();
    for (const SourceFile& file : files_) {
      if (!file.is_header()) continue;
      const bool shows = std::any_of(file.angled.begin(), file.angled.end(), is_third_party) ||
                         std::any_of(file.quoted.begin(), file.quoted.end(),
                                     [&](const std::string& n) { return showing.count(n) > 0; });
      if (shows) showing.insert(file.path);
    }
  }
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    for (const std::string& name : file.quoted) {
      if (showing.count(name) == 0 || file.room->sees_inside) continue;
      if (in_one_layer(*file.room, room_of(name))) continue;
      found.push_back(file.path + " includes " + name + ", which shows a third-party header");
    }
  }
  return found;
}

std::vector<std::string> House::private_headers_used_elsewhere() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    if (file.room->sees_inside) continue;
    for (const std::string& name : file.quoted) {
      const SourceFile* header = find(name);
      const std::string folder = header == nullptr ? "" : private_to(*header);
      if (folder.empty() || file.path.starts_with(folder + "/")) continue;
      found.push_back(file.path + " includes " + name + ", which is private to " + folder);
    }
  }
  return found;
}

std::vector<std::string> House::names_defined_twice() const {
  std::map<std::string, std::set<std::string>> places;
  for (const SourceFile& file : files_) {
    if (file.once_a_target()) continue;
    for (const Definition& definition : file.declared.definitions) {
      if (!one_in_the_program(definition)) continue;
      const bool function = definition.kind == Definition::Kind::function;
      places[kind_of(definition) + definition.name +
             (function ? "(" + definition.parameters + ")" : "")]
          .insert(file.path);
    }
  }
  std::vector<std::string> found;
  for (const auto& [name, files] : places) {
    if (files.size() < 2) continue;
    std::string line = name + " is defined in";
    for (const std::string& file : files) line += " " + file;
    found.push_back(line);
  }
  return found;
}

std::vector<std::string> House::namespaces_of_other_rooms() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    const std::string& own = file.room->name_space;
    bool opens_own = false;
    for (const auto& [name, holds_more] : file.declared.namespaces) {
      const Room* other = nullptr;
      for (const Room& room : rooms()) {
        if (&room != file.room && (name + "::").starts_with(room.name_space + "::") &&
            room.name_space.size() > own.size()) {
          other = &room;
        }
      }
      const bool inside = (name + "::").starts_with(own + "::") && other == nullptr;
      opens_own = opens_own || inside;
      if (!inside && holds_more && name != "std")
        found.push_back(file.path + " opens namespace " + name);
    }
    for (const Definition& definition : file.declared.definitions) {
      if (definition.name.find("::") == std::string::npos && one_in_the_program(definition))
        found.push_back(file.path + " defines " + definition.name + " in no namespace");
    }
    if (!opens_own && !file.path.ends_with("main.cpp")) {
      found.push_back(file.path + " does not open namespace " + own);
    }
  }
  return found;
}

std::vector<std::string> House::unguarded_or_unexplained_headers() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    if (!file.is_header()) continue;
    if (!file.text.starts_with("/// \\file ")) {
      found.push_back(file.path + " does not begin by saying what it is for");
    }
    if (!file.once_a_target() && file.text.find("#pragma once") == std::string::npos) {
      found.push_back(file.path + " does not guard itself");
    }
  }
  return found;
}

}  // namespace touchtrial::house
