// What the list of pairs keeps.
#include "physics/collision/archive.h"

#include "physics/collision/pairs.h"

namespace physics::collision {

// Of what is not known, or where nothing was found, the next look reads nothing.
void Pairs::archiveFinding(Archive& a, const Watch& watch) {
  auto& [pose, manifold, more] = findings_[static_cast<std::size_t>(watch.finding)];
  if (a.reads()) name(watch, manifold);
  if (watch.known) a(pose);
  if (watch.count > 0) a(manifold, more);
}

// The tree of bounds is built anew: what it finds is sorted, so that its shape changes nothing.
void Pairs::archive(Archive& a) {
  std::size_t findings = findings_.size();
  a(items_, told_, fat_, moving_, late_, treeIndex_, itemOfTree_, treeBounds_, ignoredMore_,
    margin_, broadPhaseCalls_, watches_, parked_, findings, free_, moved_, movedTree_);
  findings_.resize(findings);
  for (std::vector<Watch>* list : {&watches_, &parked_}) {
    for (const Watch& watch : *list) archiveFinding(a, watch);
  }
  if (!a.reads()) return;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const auto& [from, to] = told_[i];
    setMotion(items_[i], from.q.toRotationMatrix(), from, to);
  }
  tree_.clear();
  for (std::size_t t = 0; t < itemOfTree_.size(); ++t) {
    tree_.add(treeBounds_[t], items_[itemOfTree_[t]].solid.kind == SolidKind::point);
  }
}

}  // namespace physics::collision
