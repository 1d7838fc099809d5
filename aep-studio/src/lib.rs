//! The report page: a self-contained HTML document of a discovery.
