/* The only file that knows libyaml. A text is scanned first (depth, anchors, aliases, tags), so that the loader meets
 * nothing that grows or refers elsewhere; then it is loaded and copied into a tree of kz_node. */
#include <yaml.h>

#include "scene.h"

enum { MAX_DEPTH = 16 };

typedef struct {
  const char *text;
  size_t length;
  const char *source;
  bool option;
} source_text;

/* A token that a scene may not have, and the complaint about it. */
static const struct {
  yaml_token_type_t type;
  bool in_options_only;
  const char *wrong;
} refused_tokens[] = {
    {YAML_ANCHOR_TOKEN, false, "an anchor (&name) stands here; write the value out"},
    {YAML_ALIAS_TOKEN, false, "an alias (*name) stands here; write the value out"},
    {YAML_TAG_TOKEN, false, "a tag (!name) stands here; give the value without it"},
    {YAML_TAG_DIRECTIVE_TOKEN, false, "a %TAG directive stands here; leave tags out"},
    {YAML_BLOCK_MAPPING_START_TOKEN, true, "is a block mapping; write flow text such as {min: -2, max: 2}"},
    {YAML_BLOCK_SEQUENCE_START_TOKEN, true, "is a block list; write flow text such as [1, 2]"},
};

static kz_status yaml_refuse(const source_text *source, size_t line, size_t column, const char *wrong) {
  if (source->option) return kz_fail(KZ_REFUSED, "%s: %s", source->source, wrong);
  return kz_fail(KZ_REFUSED, "%s:%zu:%zu: scene: %s", source->source, line + 1, column + 1, wrong);
}

/* Where libyaml's reader or scanner failed. The reader gives only an offset in bytes. */
static kz_status refuse_problem(const source_text *source, const yaml_parser_t *parser) {
  char wrong[256];
  size_t line = parser->problem_mark.line, column = parser->problem_mark.column;
  if (parser->error == YAML_MEMORY_ERROR) return kz_fail(KZ_FAILED, "%s: out of memory", source->source);
  if (parser->error == YAML_READER_ERROR) {
    const size_t end = parser->problem_offset < source->length ? parser->problem_offset : source->length;
    line = column = 0;
    for (size_t i = 0; i < end; i++) {
      column = source->text[i] == '\n' ? 0 : column + (((unsigned char)source->text[i] & 0xC0) != 0x80);
      line += source->text[i] == '\n';
    }
    snprintf(wrong, sizeof wrong, "is not text (%s); save the scene in UTF-8 without control characters",
             parser->problem);
  } else {
    const size_t at = parser->problem_mark.index;
    const bool tab = at < source->length && source->text[at] == '\t';
    snprintf(wrong, sizeof wrong, "is not YAML: %s%s%s%s; write lines such as \"key: value\", indented with spaces",
             parser->problem ? parser->problem : "malformed", parser->context ? " " : "",
             parser->context ? parser->context : "", tab ? " (a tab stands here)" : "");
  }
  return yaml_refuse(source, line, column, wrong);
}

static int depth_change(yaml_token_type_t type) {
  const bool begins = type == YAML_BLOCK_SEQUENCE_START_TOKEN || type == YAML_BLOCK_MAPPING_START_TOKEN ||
                      type == YAML_FLOW_SEQUENCE_START_TOKEN || type == YAML_FLOW_MAPPING_START_TOKEN;
  const bool ends =
      type == YAML_BLOCK_END_TOKEN || type == YAML_FLOW_SEQUENCE_END_TOKEN || type == YAML_FLOW_MAPPING_END_TOKEN;
  return begins - ends;
}

static kz_status check_token(const source_text *source, const yaml_token_t *token, int depth) {
  const yaml_mark_t *at = &token->start_mark;
  for (size_t i = 0; i < sizeof refused_tokens / sizeof refused_tokens[0]; i++)
    if (token->type == refused_tokens[i].type && (source->option || !refused_tokens[i].in_options_only))
      return yaml_refuse(source, at->line, at->column, refused_tokens[i].wrong);
  if (depth > MAX_DEPTH)
    return yaml_refuse(source, at->line, at->column, "is nested too deeply; at most 16 levels are possible");
  return KZ_OK;
}

static void start_parser(yaml_parser_t *parser, const source_text *source) {
  yaml_parser_set_encoding(parser, YAML_UTF8_ENCODING);
  yaml_parser_set_input_string(parser, (const unsigned char *)source->text, source->length);
}

static kz_status yaml_scan(const source_text *source) {
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return kz_fail(KZ_FAILED, "%s: out of memory", source->source);
  start_parser(&parser, source);
  kz_status status = KZ_OK;
  bool end = false;
  for (int depth = 0; status == KZ_OK && !end;) {
    yaml_token_t token;
    if (!yaml_parser_scan(&parser, &token)) {
      status = refuse_problem(source, &parser);
      break;
    }
    depth += depth_change(token.type);
    status = check_token(source, &token, depth);
    end = token.type == YAML_STREAM_END_TOKEN;
    yaml_token_delete(&token);
  }
  yaml_parser_delete(&parser);
  return status;
}

static kz_node *yaml_copy(yaml_document_t *document, const source_text *source, const yaml_node_t *from);

/* Appends a copy of `from` to *end, named by the scalar `key` (NULL in a list). */
static void copy_child(yaml_document_t *document, const source_text *source, const yaml_node_t *key, int from,
                       kz_node ***end) {
  kz_node *child = **end = yaml_copy(document, source, yaml_document_get_node(document, from));
  *end = &child->next;
  if (!key) return;
  free(child->name);
  child->name = kz_strdup(key->type == YAML_SCALAR_NODE ? (const char *)key->data.scalar.value : "?");
  child->name_line = source->option ? 0 : (int)key->start_mark.line + 1;
  child->name_column = source->option ? 0 : (int)key->start_mark.column + 1;
}

static void copy_children(yaml_document_t *document, const source_text *source, const yaml_node_t *from,
                          kz_node *node) {
  kz_node **end = &node->first;
  if (from->type == YAML_SEQUENCE_NODE)
    for (const yaml_node_item_t *item = from->data.sequence.items.start; item < from->data.sequence.items.top; item++)
      copy_child(document, source, NULL, *item, &end);
  else if (from->type == YAML_MAPPING_NODE)
    for (const yaml_node_pair_t *pair = from->data.mapping.pairs.start; pair < from->data.mapping.pairs.top; pair++)
      copy_child(document, source, yaml_document_get_node(document, pair->key), pair->value, &end);
}

static kz_node *yaml_copy(yaml_document_t *document, const source_text *source, const yaml_node_t *from) {
  static const kz_node_kind kinds[] = {
      [YAML_SCALAR_NODE] = KZ_SCALAR, [YAML_SEQUENCE_NODE] = KZ_SEQUENCE, [YAML_MAPPING_NODE] = KZ_MAPPING};
  kz_node *node = kz_calloc(1, sizeof *node);
  node->kind = kinds[from->type];
  node->source = source->source;
  node->line = source->option ? 0 : (int)from->start_mark.line + 1;
  node->column = source->option ? 0 : (int)from->start_mark.column + 1;
  node->name = kz_strdup("");
  if (node->kind == KZ_SCALAR) {
    node->plain = from->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    node->text = kz_node_text((const char *)from->data.scalar.value, from->data.scalar.length);
  }
  copy_children(document, source, from, node);
  return node;
}

/* Loads the next document; *root = NULL at the end of the text. */
static kz_status load_next(yaml_parser_t *parser, const source_text *source, kz_node **root) {
  yaml_document_t document;
  *root = NULL;
  if (!yaml_parser_load(parser, &document)) return refuse_problem(source, parser);
  const yaml_node_t *top = yaml_document_get_root_node(&document);
  if (top) *root = yaml_copy(&document, source, top);
  yaml_document_delete(&document);
  return KZ_OK;
}

static kz_status yaml_load(const source_text *source, kz_node **root) {
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return kz_fail(KZ_FAILED, "%s: out of memory", source->source);
  start_parser(&parser, source);
  kz_node *second = NULL;
  kz_status status = load_next(&parser, source, root);
  if (status == KZ_OK && !*root)
    status = yaml_refuse(
        source, 0, 0, source->option ? "has no value; give a value after =" : "is empty; give a pendulum and a study");
  else if (status == KZ_OK)
    status = load_next(&parser, source, &second);
  if (second)
    status = yaml_refuse(source, (size_t)second->line - 1, (size_t)second->column - 1,
                         "a second YAML document begins here; a scene is a single one");
  kz_tree_free(second);
  yaml_parser_delete(&parser);
  if (status == KZ_OK) return KZ_OK;
  kz_tree_free(*root);
  *root = NULL;
  return status;
}

kz_status kz_tree_read(const char *text, size_t length, const char *source, bool option, kz_node **root) {
  const source_text from = {.text = text, .length = length, .source = source, .option = option};
  *root = NULL;
  if (length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0)
    return yaml_refuse(&from, 0, 0, "begins with a byte-order mark; save it in UTF-8 without one");
  KZ_TRY(yaml_scan(&from));
  return yaml_load(&from, root);
}
