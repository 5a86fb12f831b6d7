// Based on: glTF 2.0 specification, sections 3.6 "Binary Data Storage" and 3.11 "Animations" (normalized
// integers). Differs in: offsets that are not aligned are read all the same.
#include "apps/scene/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace limn::scene {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's arrays are little-endian");

std::size_t componentBytesOf(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

/// Bytes of an element; columns of small matrices start at multiples of four.
std::size_t elementBytes(int type, std::size_t componentBytes) {
  switch (type) {
    case TINYGLTF_TYPE_MAT2:
      return 2 * std::max<std::size_t>(4, 2 * componentBytes);
    case TINYGLTF_TYPE_MAT3:
      return 3 * ((3 * componentBytes + 3) / 4 * 4);
    default:
      return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type))) *
             componentBytes;
  }
}

bool hasView(const GltfDocument& document, const tinygltf::Accessor& accessor) {
  return static_cast<std::size_t>(accessor.bufferView) < document.viewCount;
}

/// Whether `count` elements from byte `offset`, `stride` apart, lie in `view`. All values are below 2^53.
void checkExtent(const GltfDocument& document, const std::string& place, std::size_t count,
                 std::size_t offset, std::size_t stride, std::size_t bytesEach, int view) {
  const std::size_t available = document.model.bufferViews[static_cast<std::size_t>(view)].byteLength;
  if (count == 0 || offset + stride * (count - 1) + bytesEach <= available) return;
  document.refuse(place, std::to_string(count) + " elements of " + std::to_string(bytesEach) +
                             " bytes from byte " + std::to_string(offset) + ", " + std::to_string(stride) +
                             " apart, do not fit into bufferView " + std::to_string(view) + " of " +
                             std::to_string(available) + " bytes; is the file whole?");
}

void checkSparse(const GltfDocument& document, std::size_t index, const tinygltf::Accessor& accessor,
                 std::size_t bytesEach) {
  const auto& sparse = accessor.sparse;
  const auto place = [&](const char* part) { return jsonPointer("accessors", index, "sparse", part); };
  const std::size_t count = static_cast<std::size_t>(sparse.count);
  if (count > accessor.count) {
    document.refuse(place("count"), "is " + std::to_string(count) + ", more than the accessor's " +
                                        std::to_string(accessor.count) + " elements");
  }
  const int type = sparse.indices.componentType;
  const std::size_t indexBytes = type == TINYGLTF_COMPONENT_TYPE_FLOAT ? 0 : componentBytesOf(type);
  if (indexBytes == 0 || type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_SHORT) {
    document.refuse(place("indices/componentType"),
                    "is " + std::to_string(type) + "; 5121, 5123 or 5125 belongs here");
  }
  checkExtent(document, place("indices"), count, static_cast<std::size_t>(sparse.indices.byteOffset),
              indexBytes, indexBytes, sparse.indices.bufferView);
  checkExtent(document, place("values"), count, static_cast<std::size_t>(sparse.values.byteOffset), bytesEach,
              bytesEach, sparse.values.bufferView);
}

void checkAccessor(GltfDocument& document, std::size_t index) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  const std::size_t componentBytes = componentBytesOf(accessor.componentType);
  if (componentBytes == 0) {
    document.refuse(jsonPointer("accessors", index, "componentType"),
                    "is " + std::to_string(accessor.componentType) +
                        "; one of 5120, 5121, 5122, 5123, 5125, 5126 belongs here");
  }
  const std::size_t bytesEach = elementBytes(accessor.type, componentBytes);
  if (hasView(document, accessor)) {
    const auto& view = document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    const std::size_t stride = view.byteStride == 0 ? bytesEach : view.byteStride;
    if (stride < bytesEach) {
      document.refuse(jsonPointer("bufferViews", accessor.bufferView, "byteStride"),
                      "is " + std::to_string(stride) + ", but the elements of accessor " +
                          std::to_string(index) + " have " + std::to_string(bytesEach) + " bytes");
    }
    checkExtent(document, jsonPointer("accessors", index), accessor.count, accessor.byteOffset, stride,
                bytesEach, accessor.bufferView);
  }
  if (accessor.sparse.isSparse) checkSparse(document, index, accessor, bytesEach);
}

void checkView(const GltfDocument& document, std::size_t index) {
  const tinygltf::BufferView& view = document.model.bufferViews[index];
  const std::size_t length = document.buffers[static_cast<std::size_t>(view.buffer)].length;
  if (view.byteOffset + view.byteLength <= length) return;
  document.refuse(jsonPointer("bufferViews", index),
                  std::to_string(view.byteLength) + " bytes from byte " + std::to_string(view.byteOffset) +
                      " do not fit into buffer " + std::to_string(view.buffer) + " of " +
                      std::to_string(length) + " bytes; is the file whole?");
}

const std::uint8_t* bytesOf(const GltfDocument& document, int view, std::size_t offset) {
  const auto& described = document.model.bufferViews[static_cast<std::size_t>(view)];
  const GltfBuffer& buffer = document.buffers[static_cast<std::size_t>(described.buffer)];
  if (!buffer.bytes) {
    document.refuse(jsonPointer("buffers", described.buffer),
                    "has no \"uri\", and the file no binary chunk for it");
  }
  return buffer.bytes->data() + described.byteOffset + offset;
}

template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

std::uint32_t wholeAt(const std::uint8_t* bytes, int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

}  // namespace

void checkAccessors(GltfDocument& document) {
  for (std::size_t i = 0; i < document.viewCount; ++i) checkView(document, i);
  for (std::size_t i = 0; i < document.model.accessors.size(); ++i) checkAccessor(document, i);
}

AccessorReader::AccessorReader(GltfDocument& document, int accessor)
    : document_(document), index_(static_cast<std::size_t>(accessor)) {
  const tinygltf::Accessor& described = document.model.accessors[index_];
  count_ = described.count;
  components_ =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(described.type)));
  componentType_ = described.componentType;
  componentBytes_ = componentBytesOf(componentType_);
  normalized_ = described.normalized;
  const std::size_t bytesEach = elementBytes(described.type, componentBytes_);
  stride_ = bytesEach;
  if (hasView(document, described) && count_ > 0) {
    const auto& view = document.model.bufferViews[static_cast<std::size_t>(described.bufferView)];
    if (view.byteStride != 0) stride_ = view.byteStride;
    bytes_ = bytesOf(document, described.bufferView, described.byteOffset);
  }
  if (!described.sparse.isSparse || described.sparse.count == 0) return;
  const auto& sparse = described.sparse;
  const std::size_t sparseCount = static_cast<std::size_t>(sparse.count);
  document.charge(sparseCount * sizeof(std::uint32_t), jsonPointer("accessors", index_, "sparse", "count"));
  const std::uint8_t* indices =
      bytesOf(document, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset));
  sparseBytes_ =
      bytesOf(document, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset));
  for (std::size_t i = 0; i < sparseCount; ++i) {
    const std::uint32_t element =
        wholeAt(indices + i * componentBytesOf(sparse.indices.componentType), sparse.indices.componentType);
    const bool ascends = sparseElements_.empty() || element > sparseElements_.back();
    if (!ascends || element >= count_) {
      document.refuse(jsonPointer("accessors", index_, "sparse", "indices"),
                      "element " + std::to_string(i) + " is " + std::to_string(element) +
                          "; they must ascend and stay below the accessor's count of " +
                          std::to_string(count_));
    }
    sparseElements_.push_back(element);
  }
}

const std::uint8_t* AccessorReader::find(std::size_t element) const {
  if (sparseBytes_ != nullptr) {
    const auto found = std::lower_bound(sparseElements_.begin(), sparseElements_.end(), element);
    if (found != sparseElements_.end() && *found == element) {
      return sparseBytes_ +
             static_cast<std::size_t>(found - sparseElements_.begin()) * componentBytes_ * components_;
    }
  }
  return bytes_ == nullptr ? nullptr : bytes_ + element * stride_;
}

double AccessorReader::component(const std::uint8_t* bytes) const {
  // Normalized integers: c / 255 and the like; the most negative one is -1 too.
  switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const double value = load<std::int8_t>(bytes);
      return normalized_ ? std::max(value / 127.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalized_ ? *bytes / 255.0 : *bytes;
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const double value = load<std::int16_t>(bytes);
      return normalized_ ? std::max(value / 32767.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const double value = load<std::uint16_t>(bytes);
      return normalized_ ? value / 65535.0 : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
      const double value = load<std::uint32_t>(bytes);
      return normalized_ ? value / 4294967295.0 : value;
    }
    default:
      return static_cast<double>(load<float>(bytes));
  }
}

void AccessorReader::read(std::size_t element, std::size_t wanted, float* out) const {
  constexpr double kLargest = 1e15;
  const std::uint8_t* bytes = find(element);
  for (std::size_t c = 0; c < wanted; ++c) {
    const double value = bytes == nullptr ? 0.0 : component(bytes + c * componentBytes_);
    if (!(std::abs(value) <= kLargest)) {
      document_.refuse(place(), "element " + std::to_string(element) + " holds " +
                                    (std::isfinite(value) ? "a number beyond 1e15"
                                                          : "what is no number (infinity or NaN)") +
                                    "; export the model again");
    }
    out[c] = static_cast<float>(value);
  }
}

void AccessorReader::readWhole(std::size_t element, std::size_t wanted, std::uint32_t* out) const {
  const std::uint8_t* bytes = find(element);
  for (std::size_t c = 0; c < wanted; ++c)
    out[c] = bytes == nullptr ? 0 : wholeAt(bytes + c * componentBytes_, componentType_);
}

}  // namespace limn::scene
