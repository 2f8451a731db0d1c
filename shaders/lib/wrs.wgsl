// Twin of src/kernel/wrs.rs.
