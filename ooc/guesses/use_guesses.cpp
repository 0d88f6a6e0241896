#include "ooc/guesses/use_guesses.h"

#include <algorithm>

#include "libreeb/base/hash.h"

namespace reeb::ooc {

namespace {

// 29 bits of this are kept, so that any two vertices almost always differ.
std::uint32_t hash(VertexId v) { return static_cast<std::uint32_t>(mix(v.value()) >> 32); }

}  // namespace

UseGuesses::Verdict UseGuesses::add(Chunk& chunk, std::uint64_t most_open) {
  constexpr std::size_t kVerticesBetweenChecks = 1024;
  sum_links(chunk);
  // Checked before the table is touched, which is expensive if vertices are far apart.
  const auto open_here = static_cast<std::uint64_t>(
      std::count_if(links_.begin(), links_.end(), [](std::uint32_t link) { return !is_closed(link); }));
  if (open_here > most_open) return Verdict::kIncoherent;
  chunk.uses.resize(chunk.vertex_count());
  const std::span<const VertexId> ids = chunk.ids;
  for (std::size_t first = 0; first < ids.size(); first += kVerticesBetweenChecks) {
    if (table_.pages().is_thrashing()) return Verdict::kIncoherent;
    const std::size_t count = std::min(kVerticesBetweenChecks, ids.size() - first);
    std::uint64_t opened = 0, closed = 0, guessed = 0, revoked = 0;
    table_.change_each(ids.subspan(first, count), [&](std::size_t k, std::uint32_t& entry) {
      if ((entry & kGuessed) != 0) {
        ++revoked;
        return;
      }
      const std::uint32_t link = links_[first + k];
      const bool earlier = (entry & kUsed) != 0;
      const std::uint32_t sum = ((entry ^ link) & ~kFlags) | ((entry | link) & kFan) | kUsed;
      const bool later = !is_closed(sum);
      entry = later ? sum : kGuessed;
      opened += later;
      closed += earlier;
      guessed += !later;
      chunk.uses[first + k] = static_cast<std::uint8_t>((earlier ? kUsedEarlier : 0) | (later ? kUsedLater : 0));
    });
    open_ += opened - closed;
    guessed_ += guessed;
    revoked_ += revoked;
  }
  if (revoked_ != 0) return Verdict::kRevoked;
  return open_ > most_open ? Verdict::kIncoherent : Verdict::kHolds;
}

void UseGuesses::sum_links(const Chunk& chunk) {
  hashes_.resize(chunk.vertex_count());
  for (std::size_t i = 0; i < chunk.vertex_count(); ++i) hashes_[i] = hash(chunk.ids[i]) & ~kFlags;
  if (!sum_of_triangles(chunk)) sum_of_all(chunk);
}

// Most chunks have proper triangles only. False if this one has others.
bool UseGuesses::sum_of_triangles(const Chunk& chunk) {
  links_.assign(chunk.vertex_count(), kFan);
  const std::uint32_t* const hashes = hashes_.data();
  std::uint32_t* const links = links_.data();
  const std::uint32_t* const end = chunk.corners.data() + chunk.corners.size();
  for (const std::uint32_t* t = chunk.corners.data(); t != end; t += 3) {
    const std::uint32_t a = t[0], b = t[1], c = t[2];
    if (a == b || b == c || a == c) [[unlikely]]
      return false;
    const std::uint32_t of_a = hashes[a], of_b = hashes[b], of_c = hashes[c];
    links[a] ^= of_b ^ of_c;
    links[b] ^= of_c ^ of_a;
    links[c] ^= of_a ^ of_b;
  }
  return true;
}

void UseGuesses::sum_of_all(const Chunk& chunk) {
  links_.assign(chunk.vertex_count(), 0);
  for (std::size_t t = 0; t < chunk.corners.size(); t += 3) {
    const std::uint32_t a = chunk.corners[t], b = chunk.corners[t + 1], c = chunk.corners[t + 2];
    if (a != b && b != c && a != c) {
      links_[a] = (links_[a] ^ hashes_[b] ^ hashes_[c]) | kFan;
      links_[b] = (links_[b] ^ hashes_[c] ^ hashes_[a]) | kFan;
      links_[c] = (links_[c] ^ hashes_[a] ^ hashes_[b]) | kFan;
      continue;
    }
    ++degenerate_;
    const std::uint32_t other = b != a ? b : c;
    if (other == a) continue;  // a vertex
    links_[a] ^= hashes_[other];
    links_[other] ^= hashes_[a];
  }
}

std::uint64_t UseGuesses::take_rest(std::uint64_t first, std::uint64_t end, std::size_t most, Chunk& chunk) {
  constexpr std::uint64_t kEntriesAtOnce = 16 << 10;
  while (chunk.vertex_count() < most && (first = table_.next_unusual(first, end)) < end) {
    entries_.resize(static_cast<std::size_t>(std::min(kEntriesAtOnce, end - first)));
    table_.read(first, entries_);
    // Of a closed surface, all.
    if (static_cast<std::size_t>(std::count(entries_.begin(), entries_.end(), kGuessed)) == entries_.size()) {
      first += entries_.size();
      continue;
    }
    for (std::size_t i = 0; i < entries_.size() && chunk.vertex_count() < most; ++i, ++first) {
      if ((entries_[i] & kGuessed) != 0) continue;
      const bool used = (entries_[i] & kUsed) != 0;
      unused_ += used ? 0 : 1;
      chunk.ids.emplace_back(first);
      chunk.uses.push_back(used ? kUsedEarlier : kUsedHereOnly);
    }
  }
  return first;
}

}  // namespace reeb::ooc
