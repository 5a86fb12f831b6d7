// The mesh as it is: the baseline that every method is compared with runs through the same code.
#include "silhouette/method.h"

namespace limn::silhouette {
namespace {

class Flat final : public MethodState {
 public:
  void deform(const Mesh&) override {}
  void prepare(const Parameters&, const Crew&) override {}
  void refine(const View&, const Parameters&, const Crew&, RefinedStream& stream, RefineReport&) override {
    stream.setCounts(0, 0);
  }
};

}  // namespace

std::unique_ptr<MethodState> makeFlat(const Source&) {
  return std::make_unique<Flat>();
}

}  // namespace limn::silhouette
