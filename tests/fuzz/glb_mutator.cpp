// Mutations that leave a GLB a GLB: one of its chunks changes, and the lengths before the chunks follow. What is not of two
// chunks is mutated as bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace {

constexpr std::size_t kHeader = 12, kChunkHeader = 8, kFraming = kHeader + 2 * kChunkHeader;
using Bytes = std::vector<std::uint8_t>;

std::size_t wordAt(const std::uint8_t* data, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, data + at, sizeof value);
  return value;
}

void putWord(std::uint8_t* data, std::size_t at, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  std::memcpy(data + at, &word, sizeof word);
}

/// Bytes of the JSON chunk if exactly one other chunk follows it, else 0.
std::size_t jsonLength(const std::uint8_t* data, std::size_t size) {
  if (size < kFraming || std::memcmp(data, "glTF", 4) != 0) return 0;
  const std::size_t length = wordAt(data, kHeader);
  if (length > size - kFraming) return 0;
  return wordAt(data, kHeader + kChunkHeader + length) == size - kFraming - length ? length : 0;
}

void mutateChunk(Bytes& chunk, std::size_t room, std::uint8_t padding) {
  const std::size_t length = chunk.size();
  chunk.resize(length + room);
  chunk.resize(LLVMFuzzerMutate(chunk.data(), length, chunk.size()));
  chunk.resize((chunk.size() + 3) / 4 * 4, padding);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
  std::minstd_rand random(seed);
  const std::size_t length = jsonLength(data, size);
  constexpr std::size_t kPadding = 4;
  if (length == 0 || size + kPadding > maxSize || random() % 16 == 0)
    return LLVMFuzzerMutate(data, size, maxSize);

  const std::uint8_t* const text = data + kHeader + kChunkHeader;
  Bytes json(text, text + length);
  Bytes binary(text + length + kChunkHeader, static_cast<const std::uint8_t*>(data) + size);
  const std::size_t room = maxSize - size - kPadding;
  if (random() % 2 == 0)
    mutateChunk(json, room, ' ');
  else
    mutateChunk(binary, room, 0);

  const std::size_t total = kFraming + json.size() + binary.size();
  putWord(data, 8, total);
  putWord(data, kHeader, json.size());
  std::uint8_t* out = std::copy(json.begin(), json.end(), data + kHeader + kChunkHeader);
  putWord(out, 0, binary.size());
  std::memcpy(out + 4, "BIN\0", 4);
  std::copy(binary.begin(), binary.end(), out + kChunkHeader);
  return total;
}
