// Based on: glTF 2.0 specification, appendix A, "JSON Schema Reference", and the extensions' own schemas.
// Differs in: empty arrays pass, and ranges are only those that drawing depends on.
#include "apps/scene/gltf_schema.h"

#include <array>

namespace limn::scene::schema {
namespace {

using Words = std::span<const std::string_view>;
using Fields = std::span<const Field>;

constexpr double kLargestWhole = 9007199254740992.0;  // 2^53: every whole number up to here is a double
constexpr double kLargestInt = 2147483647.0;          // where tinygltf keeps an int
constexpr double kLargest = 1e15;
constexpr double kHuge = 1e38;

constexpr Field text(std::string_view name) {
  return {.name = name};
}
constexpr Field texts(std::string_view name) {
  return {.name = name, .isArray = true};
}
constexpr Field word(std::string_view name, Words words) {
  return {.name = name, .kind = Kind::kWord, .words = words};
}
constexpr Field flag(std::string_view name) {
  return {.name = name, .kind = Kind::kFlag};
}
constexpr Field whole(std::string_view name, double low, double high = kLargestWhole) {
  return {.name = name, .kind = Kind::kWhole, .low = low, .high = high};
}
constexpr Field number(std::string_view name, double low, double high) {
  return {.name = name, .kind = Kind::kNumber, .low = low, .high = high};
}
constexpr Field numbers(std::string_view name, std::size_t length, double low = -kLargest,
                        double high = kLargest) {
  return {.name = name, .kind = Kind::kNumber, .isArray = true, .length = length, .low = low, .high = high};
}
constexpr Field index(std::string_view name, Words array) {
  return {.name = name, .kind = Kind::kIndex, .words = array};
}
constexpr Field indices(std::string_view name, Words array) {
  return {.name = name, .kind = Kind::kIndex, .isArray = true, .words = array};
}
constexpr Field object(std::string_view name, Fields fields) {
  return {.name = name, .kind = Kind::kObject, .fields = fields};
}
constexpr Field objects(std::string_view name, Fields fields) {
  return {.name = name, .kind = Kind::kObject, .isArray = true, .fields = fields};
}
constexpr Field required(Field field) {
  field.required = true;
  return field;
}

constexpr std::string_view kAccessors[] = {"accessors"};
constexpr std::string_view kBufferViews[] = {"bufferViews"};
constexpr std::string_view kBuffers[] = {"buffers"};
constexpr std::string_view kCameras[] = {"cameras"};
constexpr std::string_view kImages[] = {"images"};
constexpr std::string_view kLights[] = {"lights"};
constexpr std::string_view kMaterials[] = {"materials"};
constexpr std::string_view kMeshes[] = {"meshes"};
constexpr std::string_view kNodes[] = {"nodes"};
constexpr std::string_view kSamplers[] = {"samplers"};
constexpr std::string_view kScenes[] = {"scenes"};
constexpr std::string_view kSkins[] = {"skins"};
constexpr std::string_view kTextures[] = {"textures"};

constexpr std::string_view kElementTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr std::string_view kCameraTypes[] = {"perspective", "orthographic"};
constexpr std::string_view kLightTypes[] = {"directional", "point", "spot"};
constexpr std::string_view kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};

constexpr Field kAsset[] = {required(text("version")), text("minVersion")};

constexpr Field kSparseIndices[] = {required(index("bufferView", kBufferViews)),
                                    whole("byteOffset", 0, kLargestInt),
                                    required(whole("componentType", 5120, 5126))};
constexpr Field kSparseValues[] = {required(index("bufferView", kBufferViews)),
                                   whole("byteOffset", 0, kLargestInt)};
constexpr Field kSparse[] = {required(whole("count", 0, kLargestInt)),
                             required(object("indices", kSparseIndices)),
                             required(object("values", kSparseValues))};
constexpr Field kAccessor[] = {required(whole("componentType", 5120, 5126)),
                               required(whole("count", 0)),
                               required(word("type", kElementTypes)),
                               index("bufferView", kBufferViews),
                               whole("byteOffset", 0),
                               flag("normalized"),
                               object("sparse", kSparse)};
constexpr Field kBufferView[] = {required(index("buffer", kBuffers)), required(whole("byteLength", 0)),
                                 whole("byteOffset", 0), whole("byteStride", 4, 252)};
constexpr Field kBuffer[] = {required(whole("byteLength", 0)), text("uri")};

constexpr Field kPrimitive[] = {
    {.name = "attributes", .kind = Kind::kIndexMap, .required = true, .words = kAccessors},
    {.name = "targets", .kind = Kind::kIndexMap, .isArray = true, .words = kAccessors},
    index("indices", kAccessors),
    index("material", kMaterials),
    whole("mode", 0, 6)};
constexpr Field kFittedCurves[] = {required(index("ends", kAccessors)),
                                   required(index("centers", kAccessors)), required(numbers("endScale", 3)),
                                   required(numbers("centerScale", 3)), required(text("key"))};
constexpr Field kMeshExtensions[] = {object("LIMN_fitted_curves", kFittedCurves)};
constexpr Field kMesh[] = {text("name"), required(objects("primitives", kPrimitive)), numbers("weights", 0),
                           object("extensions", kMeshExtensions)};

constexpr Field kNodeLight[] = {required(index("light", kLights))};
constexpr Field kNodeExtensions[] = {object("KHR_lights_punctual", kNodeLight)};
constexpr Field kNode[] = {text("name"),
                           index("camera", kCameras),
                           indices("children", kNodes),
                           index("skin", kSkins),
                           numbers("matrix", 16),
                           index("mesh", kMeshes),
                           numbers("rotation", 4),
                           numbers("scale", 3),
                           numbers("translation", 3),
                           numbers("weights", 0),
                           object("extensions", kNodeExtensions)};
constexpr Field kScene[] = {text("name"), indices("nodes", kNodes)};
constexpr Field kSkin[] = {text("name"), index("inverseBindMatrices", kAccessors),
                           required(indices("joints", kNodes)), index("skeleton", kNodes)};

constexpr Field kTextureTransform[] = {numbers("offset", 2), number("rotation", -kLargest, kLargest),
                                       numbers("scale", 2), whole("texCoord", 0, 255)};
constexpr Field kTextureInfoExtensions[] = {object("KHR_texture_transform", kTextureTransform)};
constexpr Field kTextureInfo[] = {
    required(index("index", kTextures)), whole("texCoord", 0, 255), number("scale", -kLargest, kLargest),
    number("strength", -kLargest, kLargest), object("extensions", kTextureInfoExtensions)};
constexpr Field kMetallicRoughness[] = {
    numbers("baseColorFactor", 4), object("baseColorTexture", kTextureInfo),
    number("metallicFactor", -kLargest, kLargest), number("roughnessFactor", -kLargest, kLargest),
    object("metallicRoughnessTexture", kTextureInfo)};
constexpr Field kEmissiveStrength[] = {number("emissiveStrength", 0, kLargest)};
constexpr Field kMaterialExtensions[] = {object("KHR_materials_unlit", {}),
                                         object("KHR_materials_emissive_strength", kEmissiveStrength)};
constexpr Field kMaterial[] = {text("name"),
                               object("pbrMetallicRoughness", kMetallicRoughness),
                               object("normalTexture", kTextureInfo),
                               object("occlusionTexture", kTextureInfo),
                               object("emissiveTexture", kTextureInfo),
                               numbers("emissiveFactor", 3),
                               word("alphaMode", kAlphaModes),
                               number("alphaCutoff", -kLargest, kLargest),
                               flag("doubleSided"),
                               object("extensions", kMaterialExtensions)};
constexpr Field kTexture[] = {index("sampler", kSamplers), index("source", kImages)};
constexpr Field kImage[] = {text("uri"), text("mimeType"), index("bufferView", kBufferViews)};
constexpr Field kSampler[] = {whole("magFilter", 9728, 9729), whole("minFilter", 9728, 9987),
                              whole("wrapS", 10497, 33648), whole("wrapT", 10497, 33648)};

constexpr Field kChannelTarget[] = {index("node", kNodes), required(text("path"))};
constexpr Field kChannel[] = {required(whole("sampler", 0, kLargestInt)),
                              required(object("target", kChannelTarget))};
constexpr Field kAnimationSampler[] = {required(index("input", kAccessors)),
                                       required(index("output", kAccessors)),
                                       word("interpolation", kInterpolations)};
constexpr Field kAnimation[] = {text("name"), required(objects("channels", kChannel)),
                                required(objects("samplers", kAnimationSampler))};

constexpr Field kPerspective[] = {required(number("yfov", 0, kHuge)), required(number("znear", 0, kHuge)),
                                  number("zfar", 0, kHuge), number("aspectRatio", 0, kHuge)};
constexpr Field kOrthographic[] = {required(number("xmag", -kHuge, kHuge)),
                                   required(number("ymag", -kHuge, kHuge)),
                                   required(number("znear", 0, kHuge)), required(number("zfar", 0, kHuge))};
constexpr Field kCamera[] = {text("name"), required(word("type", kCameraTypes)),
                             object("perspective", kPerspective), object("orthographic", kOrthographic)};

constexpr Field kSpot[] = {number("innerConeAngle", 0, kLargest), number("outerConeAngle", 0, kLargest)};
constexpr Field kLight[] = {text("name"),
                            required(word("type", kLightTypes)),
                            numbers("color", 3),
                            number("intensity", 0, kLargest),
                            number("range", 0, kHuge),
                            object("spot", kSpot)};
constexpr Field kLightsExtension[] = {required(objects("lights", kLight))};
constexpr Field kRootExtensions[] = {object("KHR_lights_punctual", kLightsExtension)};

constexpr Field kRoot[] = {required(object("asset", kAsset)),
                           texts("extensionsUsed"),
                           texts("extensionsRequired"),
                           objects("buffers", kBuffer),
                           objects("bufferViews", kBufferView),
                           objects("accessors", kAccessor),
                           objects("images", kImage),
                           objects("samplers", kSampler),
                           objects("textures", kTexture),
                           objects("materials", kMaterial),
                           objects("meshes", kMesh),
                           objects("cameras", kCamera),
                           objects("nodes", kNode),
                           objects("skins", kSkin),
                           objects("animations", kAnimation),
                           objects("scenes", kScene),
                           index("scene", kScenes),
                           object("extensions", kRootExtensions)};

constexpr std::string_view kKnownExtensions[] = {"KHR_lights_punctual",   "KHR_materials_emissive_strength",
                                                 "KHR_materials_unlit",   "KHR_mesh_quantization",
                                                 "KHR_texture_transform", "LIMN_fitted_curves"};

}  // namespace

std::span<const Field> root() {
  return kRoot;
}

std::span<const std::string_view> knownExtensions() {
  return kKnownExtensions;
}

}  // namespace limn::scene::schema
