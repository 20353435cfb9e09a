// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen_ifc: reads an IFC file from stdin and writes the shapes of its products to stdout, in the form of
// limen/io/ifc_stream_format.h. limen runs it as a process of its own, since a damaged file can kill it.
//   limen_ifc [--skip ID]...
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <set>
#include <string>

#include "ifc_helper/record_writer.h"
#include "ifc_helper/shape_reader.h"
#include <ifcpp/IFC4/include/IfcAnnotation.h>
#include <ifcpp/IFC4/include/IfcGrid.h>
#include <ifcpp/IFC4/include/IfcPort.h>
#include <ifcpp/IFC4/include/IfcProduct.h>
#include <ifcpp/IFC4/include/IfcVirtualElement.h>
#include <ifcpp/model/BuildingModel.h>
#include <ifcpp/model/UnitConverter.h>
#include <ifcpp/reader/ReaderSTEP.h>
#include <unistd.h>

#include "limen/base/system.h"

namespace limen::ifc {
namespace {

constexpr int kRefused = 3;

std::string all_of_stdin() {
  keep_bytes(STDIN_FILENO);
  std::string bytes;
  std::string piece(std::size_t{1} << 20U, '\0');
  for (;;) {
    const std::ptrdiff_t got = read_some(STDIN_FILENO, piece.data(), piece.size());
    if (got <= 0) return bytes;
    bytes.append(piece, 0, static_cast<std::size_t>(got));
  }
}

/// stdout for us alone: the library's own chatter goes nowhere.
int take_stdout() {
  const int mine = duplicate(STDOUT_FILENO);
  const int nowhere = open_nowhere();
  if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
  return mine;
}

std::set<int> skipped(int argc, char** argv) {
  std::set<int> ids;
  for (int i = 1; i + 1 < argc; ++i) {
    int id = 0;
    if (std::string_view(argv[i]) != "--skip") continue;
    const char* text = argv[i + 1];
    if (std::from_chars(text, text + std::strlen(text), id).ec == std::errc{}) ids.insert(id);
  }
  return ids;
}

bool is_drawn(const std::shared_ptr<IfcProduct>& product) {
  return product && product->m_Representation && !std::dynamic_pointer_cast<IfcAnnotation>(product) &&
         !std::dynamic_pointer_cast<IfcGrid>(product) && !std::dynamic_pointer_cast<IfcPort>(product) &&
         !std::dynamic_pointer_cast<IfcVirtualElement>(product);
}

void tell(const RecordWriter& writer, std::int64_t entity, const std::string& text) {
  Payload payload;
  payload.put_entity(entity);
  payload.put_text(text);
  writer.write(IfcRecord::message, payload);
}

int refuse(const RecordWriter& writer, const std::string& why) {
  Payload payload;
  payload.put_text(why);
  writer.write(IfcRecord::refused, payload);
  return kRefused;
}

void write_product(const RecordWriter& writer, const IfcProduct& product, ShapeReader& reader) {
  Payload begin;
  begin.put_entity(product.m_entity_id);
  writer.write(IfcRecord::begin, begin);
  const std::vector<ShapeNode> shapes = reader.shapes_of(product);
  Payload payload;
  payload.put_entity(product.m_entity_id);
  payload.put_text(product.className());
  payload.put_count(shapes.size());
  for (const ShapeNode& shape : shapes) shape.append_to(payload);
  writer.write(IfcRecord::product, payload);
}

std::size_t write_products(const RecordWriter& writer, const std::shared_ptr<BuildingModel>& model,
                           const std::set<int>& skip) {
  std::int64_t current = 0;
  ShapeReader reader(model, [&](const std::string& text) { tell(writer, current, text); });
  std::size_t count = 0;
  for (const auto& [id, entity] : model->getMapIfcEntities()) {
    const auto product = std::dynamic_pointer_cast<IfcProduct>(entity);
    if (!is_drawn(product) || skip.count(id) > 0) continue;
    current = id;
    try {
      write_product(writer, *product, reader);
      ++count;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      tell(writer, id, error.what());
    }
  }
  return count;
}

using Entity = std::pair<std::string, std::shared_ptr<BuildingEntity>>;

/// Reads entity by entity, so that one that is damaged takes no other with it.
std::shared_ptr<BuildingModel> load(const std::string& text, const RecordWriter& writer) {
  auto model = std::make_shared<BuildingModel>();
  ReaderSTEP reader;
  reader.readHeader(text, model);
  std::vector<std::string> lines;
  reader.splitIntoStepLines(text, lines);
  std::vector<Entity> entities;
  for (const std::string& line : lines) {
    Entity entity;
    try {
      reader.readSingleStepLine(line, entity);
    } catch (const std::exception&) {
      continue;  // a type that the schema does not know; what needs it reports that it is missing
    }
    if (!entity.second) continue;
    model->insertEntity(entity.second, true, false);
    entities.push_back(std::move(entity));
  }
  for (const Entity& entity : entities) {
    try {
      reader.readEntityArguments(model->getIfcSchemaVersion(), {entity}, model->getMapIfcEntities());
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      tell(writer, entity.second->m_entity_id, error.what());
    }
  }
  model->updateCache();
  return model;
}

int run(const RecordWriter& writer, const std::set<int>& skip) {
  const std::shared_ptr<BuildingModel> model = load(all_of_stdin(), writer);
  if (!model->getUnitConverter()) return refuse(writer, "the file has no project with units");
  Payload loaded;
  loaded.put_number(model->getUnitConverter()->getLengthInMeterFactor());
  writer.write(IfcRecord::loaded, loaded);
  Payload end;
  end.put_count(write_products(writer, model, skip));
  writer.write(IfcRecord::end, end);
  return 0;
}

}  // namespace
}  // namespace limen::ifc

int main(int argc, char** argv) {
  using namespace limen::ifc;
  const RecordWriter writer(take_stdout());
  try {
    const int status = run(writer, skipped(argc, argv));
    // The library's clean-up takes long and can fail; all that is wanted is written.
    std::_Exit(status);
  } catch (const std::bad_alloc&) {
    std::_Exit(refuse(writer, "there is not enough memory"));
  } catch (const std::exception& error) {
    std::_Exit(refuse(writer, error.what()));
  }
}
