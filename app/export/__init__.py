"""From a document to picture files, each of them whole or absent, with bounded memory."""
