#include "protocols/design/de_bruijn.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>

namespace touchtrial::design {
namespace {

constexpr int kRoot = 0;  // any will do: circuits have no beginning

/// Wilson's algorithm: from each vertex walk at random to the tree; the last exit that the walk
/// took from a vertex is its edge, which erases the walk's loops.
std::vector<int> random_arborescence(int vertices, RandomStream& random) {
  const auto count = static_cast<std::size_t>(vertices);
  std::vector<int> exit(count, kRoot);
  std::vector<bool> in_tree(count, false);
  in_tree[kRoot] = true;
  for (int start = 0; start < vertices; ++start) {
    for (int v = start; !in_tree[v]; v = exit[v]) {
      exit[v] = static_cast<int>(random.below(count));
    }
    for (int v = start; !in_tree[v]; v = exit[v]) in_tree[v] = true;
  }
  return exit;
}

/// The exits of one vertex in the order they are taken. \param last  taken last; negative: any
std::vector<int> ordered_exits(int vertices, int last, RandomStream& random) {
  std::vector<int> exits(static_cast<std::size_t>(vertices));
  std::iota(exits.begin(), exits.end(), 0);
  std::span<int> free = exits;
  if (last >= 0) {
    std::swap(exits[static_cast<std::size_t>(last)], exits.back());
    free = free.first(free.size() - 1);
  }
  shuffle(free, random);
  return exits;
}

}  // namespace

std::vector<int> random_de_bruijn_cycle(int symbols, RandomStream& random) {
  const std::vector<int> last_exit = random_arborescence(symbols, random);
  std::vector<std::vector<int>> exits;
  for (int v = 0; v < symbols; ++v) {
    exits.push_back(ordered_exits(symbols, v == kRoot ? -1 : last_exit[v], random));
  }
  const std::size_t length = exits.size() * exits.size();
  std::vector<std::size_t> taken(exits.size(), 0);
  std::vector<int> cycle;
  for (int v = kRoot; cycle.size() < length;) {
    cycle.push_back(v);
    v = exits[v][taken[v]++];
  }
  const auto start = static_cast<std::ptrdiff_t>(random.below(length));
  std::rotate(cycle.begin(), cycle.begin() + start, cycle.end());
  return cycle;
}

}  // namespace touchtrial::design
