// Twin of src/kernel/reproject.rs.
