#include "apps/coarsen/same_vertices.h"

#include <cstring>
#include <string>
#include <unordered_map>

namespace limn::coarsen {
namespace {

template <class T>
void append(const std::vector<T>& all, std::size_t vertex, std::string& key) {
  if (all.empty()) return;
  const std::size_t size = key.size();
  key.resize(size + sizeof(T));
  std::memcpy(&key[size], &all[vertex], sizeof(T));
}

void describe(const scene::Mesh& mesh, std::size_t vertex, std::string& key) {
  append(mesh.normals, vertex, key);
  append(mesh.texcoords, vertex, key);
  append(mesh.colors, vertex, key);
  append(mesh.tangents, vertex, key);
  for (const scene::MorphTarget& target : mesh.targets) {
    append(target.positions, vertex, key);
    append(target.normals, vertex, key);
    append(target.tangents, vertex, key);
  }
  for (const scene::SkinBinding& binding : mesh.skinning) {
    append(binding.joints, vertex, key);
    append(binding.weights, vertex, key);
  }
}

}  // namespace

std::vector<Index> firstsOfTheSame(const scene::Mesh& mesh, const std::vector<Index>& pointOf) {
  std::unordered_map<std::string, Index> known;
  known.reserve(pointOf.size());
  std::vector<Index> firsts;
  firsts.reserve(pointOf.size());
  std::string key;
  for (Index vertex = 0; vertex < pointOf.size(); ++vertex) {
    key.clear();
    append(pointOf, vertex, key);
    describe(mesh, vertex, key);
    firsts.push_back(known.try_emplace(key, vertex).first->second);
  }
  return firsts;
}

}  // namespace limn::coarsen
