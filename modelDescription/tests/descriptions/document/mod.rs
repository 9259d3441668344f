//! Parts of a description, read independently of the package that wrote it.

use roxmltree::{Document, Node};

/// The definitions of types; none where there is no such part.
pub fn type_definitions<'a, 'input: 'a>(document: &'a Document<'input>) -> Vec<Node<'a, 'input>> {
    let part = elements(document.root_element()).find(|part| part.has_tag_name("TypeDefinitions"));
    part.into_iter().flat_map(elements).collect()
}

pub fn elements<'a, 'input: 'a>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(Node::is_element)
}

pub fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Node<'a, 'input> {
    elements(node).find(|child| child.has_tag_name(name)).unwrap_or_else(|| panic!("no {name}"))
}

pub fn variables<'a, 'input>(document: &'a Document<'input>) -> Vec<Node<'a, 'input>> {
    elements(child(document.root_element(), "ModelVariables")).collect()
}
