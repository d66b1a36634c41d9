// Every definition survives being written as TOML and read back.
#include <gtest/gtest.h>

#include "physics/make/arch.h"
#include "physics/make/cards.h"
#include "physics/make/chain.h"
#include "physics/make/cloth.h"
#include "physics/make/hinge.h"
#include "physics/make/prismatic.h"
#include "physics/make/ragdoll.h"
#include "physics/make/rope.h"
#include "physics/make/soft_body.h"
#include "physics/make/stack.h"
#include "physics/make/stage.h"
#include "physics/make/universal.h"
#include "physics/make/weld.h"
#include "physics/world.h"
#include "tests/scenes/field_changer.h"
#include "tests/scenes/field_text.h"

namespace scenes {
namespace {

template <class Def>
class Fields : public testing::Test {};

using Definitions = testing::Types<
    physics::BallSocketDef, physics::AxleDef, physics::ConeLimitDef, physics::TwistLimitDef,
    physics::DistanceDef, physics::SpringDef, physics::DriveDef, physics::MotorDef,
    physics::LinkDef, physics::RopeLengthDef, physics::VolumeDef, physics::BendDef,
    physics::HardeningSpringDef, physics::DragDef, physics::PanelDragDef, physics::MotorTorqueDef,
    physics::PointGravityDef, physics::ForceDef, physics::HingeDef, physics::PrismaticDef,
    physics::UniversalDef, physics::PointOnLineDef, physics::SlideLimitDef,
    physics::OrientationLockDef, physics::PerpendicularDef, physics::StackDef, physics::PyramidDef,
    physics::WallDef, physics::GridDef, physics::ChainDef, physics::BridgeDef, physics::ArchDef,
    physics::CardHouseDef, physics::DominoesDef, physics::BowlDef, physics::WeldDef,
    physics::StairsDef, physics::RagdollDef, physics::RopeDef, physics::ClothDef,
    physics::SoftBodyDef, physics::ArmDef>;
TYPED_TEST_SUITE(Fields, Definitions);

TYPED_TEST(Fields, SurviveWritingAndReading) {
  TypeParam written;
  FieldChanger change;
  TypeParam::fields(change, written);
  const std::string text = textOfDef(written);

  const Value table = parseToml(text, "fields.toml");
  const std::map<std::string, physics::BodyId> ids{{"b1", 1}, {"b2", 2}, {"b3", 3}, {"b4", 4}};
  const Context context{"fields.toml", &ids};
  TableReader reader(table, TypeParam::kWord, context);
  TypeParam read;
  TypeParam::fields(reader, read);
  reader.finish();
  EXPECT_EQ(textOfDef(read), text);
}

}  // namespace
}  // namespace scenes
