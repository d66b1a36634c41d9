// What the list of pairs keeps.
#include "physics/collision/archive.h"

#include "physics/collision/pairs.h"

namespace physics::collision {

// The tree of bounds is built anew: what it finds is sorted, so that its shape changes nothing.
void Pairs::archive(Archive& a) {
  a(items_, told_, fat_, moving_, late_, treeIndex_, itemOfTree_, treeBounds_, ignoredMore_,
    margin_, broadPhaseCalls_, watches_, parked_, findings_, free_, moved_, movedTree_);
  if (!a.reads()) return;
  for (std::size_t t = 0; t < itemOfTree_.size(); ++t) {
    tree_.add(treeBounds_[t], items_[itemOfTree_[t]].solid.kind == Kind::point);
  }
}

}  // namespace physics::collision
