// Twin of src/kernel/scrub.rs.
